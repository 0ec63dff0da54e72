// What a method is to the library: a table (MethodInfo) and an object that adds its passes to a graph. To write one, read
// methods/hbao.cpp, add a file beside it, a folder of shaders and one line in registry.cpp.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "graph/graph.h"
#include "obscura/ao.h"
#include "shared/falloff.h"
#include "shared/view.h"
#include "shared/volume.h"

namespace obscura::ao {

// Occupied cells of the world, where the frame brings them; laid out as shared/volume.h says. What traces them has a program for
// either structure.
struct VolumeInput {
    graph::BufferId bits;        // storage buffer
    graph::BufferId block;       // Volume as a uniform buffer
    VolumeStructure structure = VolumeStructure::dense;
    explicit operator bool() const { return bool(bits); }
};

// Depth layers as DepthLayers in obscura/ao.h describes them, to be sampled. Either may be missing.
struct LayerSources {
    graph::ImageId thickness, second;
};

// What prepare() hands to every method.
struct Inputs {
    shared::View view;
    graph::BufferId viewBlock;   // View as a uniform buffer
    graph::ImageId depth;        // R32F, view.size: linear depth, sky at view.skyDepth
    graph::ImageId normals;      // R32UI, view.size: geometric eye-space normals, packNormal()
    graph::ImageId motion;       // two floats, view.size, optional: times motionScale, px from this frame's position to last frame's
    float motionScale[2];
    float previousFromEye[12];   // three rows: where a point of this frame's eye space that stands still in the world was in last frame's
    LayerSources layers;         // optional; what the values leave unused is left out
    VolumeInput volume;          // optional
    shared::FalloffBlock falloff;
    Falloff falloffDesc;
};

// Values of a method's parameters, in the order of its table.
class Values {
public:
    explicit Values(const MethodInfo& info);                     // initial values
    bool apply(const Preset& preset);
    void resolve(const Preset& preset);                          // one of resolvePresets(): over what is there, as far as the method has it
    bool set(const char* id, float value);                       // clamped; false: unknown id
    bool has(const char* id) const;
    float operator[](const char* id) const;                      // asserts that it exists
    uint32_t count(const char* id) const { return uint32_t((*this)[id] + 0.5f); }
    const MethodInfo& info() const { return *m_info; }
    std::span<const float> values() const { return m_values; }
    bool operator==(const Values&) const = default;

private:
    const MethodInfo* m_info;
    std::vector<float> m_values;
};

// What of the depth buffer a method takes for solid: a point is blocked where the surface that the picture shows there is nearer to the
// receiver than `reach` and less than `thickness` before the point. Off-screen occluders (offscreen.h) leave such points to the method.
struct Blocking {
    static constexpr float kEndless = std::numeric_limits<float>::infinity();
    float reach = kEndless, thickness = kEndless;  // metres
    // At least 0: the frame's depth layers tell instead where each thing ends, and the second surface is asked likewise. How thick open
    // sheets are, metres.
    float sheet = -1.0f;
};

class Method {
public:
    virtual ~Method() = default;
    // Adds passes; returns visibility, R16F, view.visible in size. Called every frame.
    virtual graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Values& values) = 0;
    // The default is a horizon method's: what is within reach hides all that is behind it. One that gives surfaces a thickness says
    // which; one that takes even the farthest for solid says endless reach, and nothing hidden is added to it.
    virtual Blocking blocking(const Inputs& inputs, const Values&) const { return {inputs.falloff.reach, Blocking::kEndless}; }
    // Histories, if any, are void after this: camera cut, method switch.
    virtual void reset() {}
};

// How much of the depth layers a method reads: the value of its parameter `depth_layers`, none where it has no such parameter.
enum class LayerUse : uint32_t { none, first, secondHalf, second };
LayerUse layersOf(const Values& values);
inline constexpr const char* kLayerChoices[] = {"none", "thickness", "two, half size", "two"};  // of such a parameter

struct MethodEntry {
    const MethodInfo* info;
    // Null, with a log line, when a pipeline cannot be made.
    std::unique_ptr<Method> (*create)(gpu::Device& device, const gpu::ShaderLibrary& shaders);
    // What these settings need beyond the table's Needs; may be null.
    uint32_t (*needs)(const Values& values) = nullptr;
};
std::span<const MethodEntry> registry();

// Needs of a method with these settings: a renderer asks before it makes motion, layers or a volume.
uint32_t needs(const Values& values);

std::span<const gpu::EmbeddedShader> shaders();  // this room's, for ShaderLibrary::add

shared::FalloffBlock falloffBlock(const Falloff& falloff);

}  // namespace obscura::ao
