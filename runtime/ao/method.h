// A method: a table (MethodInfo) and an object that adds its passes to a graph. To write one, read
// methods/volumetric and "Adding a method" in the README.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "ao/result.h"
#include "ao/values.h"
#include "graph/graph.h"
#include "shared/falloff.h"
#include "shared/view.h"
#include "shared/volume.h"

namespace obscura::ao {

// Occupied cells of the world, laid out as in shared/volume.h. Passes that trace them have a program for each structure.
struct VolumeInput {
    graph::BufferId bits;   // storage buffer
    graph::BufferId block;  // `volume` as a uniform buffer
    VolumeStructure structure = VolumeStructure::dense;
    shared::Volume volume{};
    explicit operator bool() const { return bool(bits); }
};

// Depth layers as DepthLayers in obscura/ao.h describes them, to be sampled. Either may be missing.
struct LayerInputs {
    graph::ImageId thickness, second;
};

// Inputs of every method, made by Prepare.
struct Inputs {
    shared::View view;
    graph::BufferId viewBlock;  // View as a uniform buffer
    graph::ImageId depth;       // R32F, view.size: linear depth, sky at view.skyDepth
    graph::ImageId normals;     // R32UI, view.size: geometric eye-space normals, packNormal()
    graph::ImageId motion;      // two floats, view.size, optional: times motionScale, px of this frame from a position to last frame's
    float motionScale[2];
    shared::View previousView;  // last frame's; without history this frame's
    float previousFromEye[12];  // three rows: this frame's eye space -> last frame's, for points at rest in the world
    float jitter[2] = {0.0f, 0.0f}, previousJitter[2] = {0.0f, 0.0f};  // px, by which a frame's image is moved beside its motion
    LayerInputs layers;                                                // optional; only those that the values use
    VolumeInput volume;                                                // optional
    shared::FalloffBlock falloff;
    Falloff falloffDesc;
};

// Which points a method counts as blocked by the depth buffer: those behind a visible surface that is nearer to the receiver than `reach`
// and less than `thickness` in front of the point. Off-screen occluders (offscreen.h) leave such points to the method.
struct Blocking {
    static constexpr float kEndless = std::numeric_limits<float>::infinity();
    float reach = kEndless, thickness = kEndless;  // metres
    float sheet = -1.0f;  // metres, >= 0: depth layers give the thickness, of the second layer too; open sheets have this one. < 0: unused
};

// Bent normals as a method gives them, before bent_normals.h averages them: what is blocked of the hemisphere's mean direction.
struct RawBentNormals {
    graph::ImageId image;  // R32G32_UINT, packed by ao/common/bent_normals.glsl; of a map with fewer pixels than the picture, if scale > 1
    uint32_t scale = 1;    // picture pixels per pixel of the map, each way
    uint32_t side = 1;     // of the tile that shares noise or directions, map pixels; 1: nothing is averaged
};

struct MethodOutput {
    graph::ImageId visibility;   // R16F, view.visible in size
    RawBentNormals bentNormals;  // of a method made by MethodEntry::createBent
    MethodOutput(graph::ImageId image, const RawBentNormals& bent = {}) : visibility(image), bentNormals(bent) {}
};

graph::ImageId rawBentNormals(graph::Graph& graph, uint32_t width, uint32_t height, const char* name);  // an image for them

class Method {
public:
    virtual ~Method() = default;
    // Adds passes. Called every frame. State for later frames changes in Graph::onRecorded only.
    virtual MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) = 0;
    // The default is a horizon method's: surfaces within reach block everything behind them. Methods with a thickness return it; methods in
    // which every surface blocks, however far, return an endless reach, and no hidden occluder is added.
    virtual Blocking blocking(const Inputs& inputs, const Values&) const { return {inputs.falloff.reach, Blocking::kEndless}; }
};

inline constexpr const char* kLayerModes[] = {"none", "thickness", "two, half size", "two"};  // of such a parameter

struct MethodEntry {
    const MethodInfo* info;
    // For frames whose falloff is of that kind; see perFalloff.
    // Null, with a log line, if a pipeline cannot be made.
    std::unique_ptr<Method> (*create)(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind falloff);
    // Makes a method that also gives bent normals; null: it has none.
    std::unique_ptr<Method> (*createBent)(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind falloff) = nullptr;
    // Needs of these values beyond the table's; may be null.
    uint32_t (*needs)(const Values& values) = nullptr;
    bool perFalloff = true;     // pipelines contain the kind of falloff (falloffConstant()): one object for each kind
    bool appliesPower = false;  // the method applies `power` and `floor` itself, before its blur
};
std::span<const MethodEntry> registry();

// Adds a pass that sets visibility 1 everywhere; R16F, `visible` in size.
graph::ImageId allOpen(graph::Graph& graph, VkExtent2D visible, const char* passName);

std::span<const gpu::EmbeddedShader> shaders();  // this module's, for ShaderLibrary::add

shared::FalloffBlock falloffBlock(const Falloff& falloff);
gpu::Constant falloffConstant(FalloffKind kind);  // of shaders that include shared/falloff.h

}  // namespace obscura::ao
