// The sample's renderer: from a World and a Camera to a picture, as passes of a render graph. Owns the GPU copies of
// models and whatever outlives a frame; changes nothing it is given.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ao/library.h"
#include "graph/graph.h"
#include "render/voxel_volume.h"
#include "scene/camera.h"
#include "scene/world.h"

namespace obscura::render {

enum class View : uint8_t {
    final, visibility, normals, shadedNormals, depth, motion, baseColor, roughness, metalness, emission, thickness, second, secondThickness,
    voxels, voxelSlice, difference, signedDifference,
    history, rejected, pass
};
// "final", "visibility", ... and "pass:NAME" (what the graph's pass NAME wrote); false when unknown.
bool parseView(const std::string& text, View& view, std::string& pass);
const char* name(View view);
inline constexpr View kViews[] = {View::final, View::visibility, View::normals, View::shadedNormals, View::depth, View::motion,
                                  View::baseColor, View::roughness, View::metalness, View::emission,
                                  View::thickness, View::second, View::secondThickness, View::voxels, View::voxelSlice, View::difference, View::signedDifference,
                                  View::history, View::rejected};
// Of the volume, which is then made whether a method needs it or not.
constexpr bool isVoxels(View view) { return view == View::voxels || view == View::voxelSlice; }
// Of two methods' visibility; where only one is run they show that one's.
constexpr bool isDifference(View view) { return view == View::difference || view == View::signedDifference; }

// The first column right of a divider, of a picture so many pixels wide.
uint32_t dividerColumn(float split, uint32_t width);

struct Sun {
    glm::vec3 direction{0.35f, -1.0f, 0.25f};  // the way light travels, world; any length
    glm::vec3 radiance{6.0f, 5.6f, 4.9f};      // linear, times pi over the horizon
    glm::vec3 sky{0.9f, 1.05f, 1.25f};         // ambient radiance from above
    glm::vec3 ground{0.45f, 0.40f, 0.34f};     // and from below
};

// Which layer of cells View::voxelSlice shows.
struct VoxelSlice {
    int axis = 1;             // that it stands across: x, y, z
    std::optional<float> at;  // metres along it; none: where the camera is
};

// How depth layers are drawn, for methods that read them. `best`: thickness alone is peeled, one geometry pass; two surfaces by the ladder or
// by three peels, whichever this device was quicker with in its first frames of them (peels where its fragment shaders may not write). The
// pictures are the same to the bit. On lavapipe, 640x360: one peel 42 ms against 77 in the atrium, 49 against
// 100 in Sponza; three 130 against 77, 150 against 100.
enum class LayerForm : uint8_t { best, peeling, ladder };

struct FrameOptions {
    VkExtent2D visible{1280, 720};    // px
    float guard = 0.1f;               // fraction of each side, 0 to 0.5
    scene::Camera camera;
    float time = 0.0f;                // seconds, of the world's animations
    const ao::Values* method = nullptr;  // names the method; never null
    ao::Falloff falloff;
    // A second setting B beside `method`, A, on the same frame with the same falloff, histories of its own: A is shown left of the
    // divider, B right of it. "A." and "B." then stand before the names of their passes. Null: none, and nothing is spent on it.
    const ao::Values* compare = nullptr;
    float split = 0.5f;               // where the divider stands, fraction of the width
    float differenceRange = 0.25f;    // difference of visibility at which the difference views end
    View view = View::final;
    std::string passView;             // for View::pass
    uint32_t sampleStep = 0;          // > 0: Outputs::samples of every so many pixels
    LayerForm layerForm = LayerForm::best;
    Voxelization voxels;              // for methods that need a volume
    VoxelSlice slice;
    Sun sun;
    float exposure = 1.0f;
    bool cut = false;                 // first frame after a jump: histories and motion are void
    bool skipMasked = false;          // leave alpha-masked primitives out (stored references do)
    bool cull = true;                 // leave out what lies outside the frustum, guard band included
    uint32_t shadowSize = 2048;       // texels a side
    float shadowReach = 40.0f;        // metres around the camera that get shadows, in worlds larger than that
};

struct Outputs {
    graph::ImageId color;       // what `view` asks for, R8G8B8A8_UNORM holding sRGB-encoded values, visible size
    graph::ImageId visibility;  // R16F, visible size, of the method, or of both as the divider shows them
    graph::ImageId sides[2];    // likewise, of A and of B alone (none where nothing is compared)
    // Of every sampleStep-th visible pixel, (i + 1/2) sampleStep from the corner: halves of A's and B's visibility, linear depth as
    // float bits, packed normal, halves of motion in px of the whole. R32G32B32A32_UINT, size / sampleStep. None unless asked for.
    graph::ImageId samples;
    // Guard band included:
    graph::ImageId depth;           // D32, reversed infinite device depth
    graph::ImageId linearDepth;     // R32F, -z in metres, ao's sky value where nothing is
    graph::ImageId normals;         // R32UI, packNormal(): geometric, eye space
    graph::ImageId motion;          // RG16F, px to last frame's position
    graph::BufferId voxels;         // bits of the volume, as shared/volume.h has them; none where the method needs none
    ao::LayerSources layers;        // R16F and RG32F, see obscura/ao.h; none unless the method reads them
};

struct SceneFacts {
    size_t triangles = 0, drawn = 0, instances = 0, draws = 0;  // drawn: after culling
    uint64_t textureBytes = 0, geometryBytes = 0;
};

class Renderer {
public:
    // Null, with a log line, when something required cannot be made.
    static std::unique_ptr<Renderer> create(gpu::Device& device, const gpu::ShaderLibrary& shaders);
    ~Renderer();

    // Uploads the models of a world that are not on the GPU yet and drops those no longer used. add() does so as well;
    // call it first where a hitch would show. A model that cannot be uploaded is logged and left out of the picture.
    gpu::Status load(const scene::World& world);

    // Adds the frame's passes. Remembers poses and camera for the next frame's motion vectors.
    Outputs add(graph::Graph& graph, const scene::World& world, const FrameOptions& options);

    ao::Library& library();
    ao::Library& otherLibrary();  // of B; made when first asked for
    SceneFacts facts() const;  // of the last add()
    const voxel::Voxels* voxels() const;  // null until a method has needed a volume

private:
    Renderer();
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

std::span<const gpu::EmbeddedShader> shaders();

}  // namespace obscura::render
