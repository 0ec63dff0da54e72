// The sample's renderer: renders a World with a Camera, as passes of a render graph. Owns the GPU copies of models and all state that
// outlives a frame; does not modify its inputs.
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
    final,
    visibility,
    normals,
    shadedNormals,
    bentNormals,
    depth,
    motion,
    baseColor,
    roughness,
    metalness,
    emission,
    thickness,
    second,
    secondThickness,
    voxels,
    voxelSlice,
    difference,
    signedDifference,
    history,
    rejected,
    pass
};
// "final", "visibility", ..., or "pass:NAME" (the first image that the graph's pass NAME writes); false if unknown.
bool parseView(const std::string& text, View& view, std::string& pass);
const char* name(View view);
inline constexpr View kViews[] = {View::final, View::visibility, View::normals, View::shadedNormals, View::bentNormals, View::depth,
    View::motion, View::baseColor, View::roughness, View::metalness, View::emission, View::thickness, View::second, View::secondThickness,
    View::voxels, View::voxelSlice, View::difference, View::signedDifference, View::history, View::rejected};
// Views of the volume; the volume is then made even if no method needs it.
constexpr bool isVoxels(View view) { return view == View::voxels || view == View::voxelSlice; }
// Views of the difference of two methods' visibility; without a second method they show the first one's visibility.
constexpr bool isDifference(View view) { return view == View::difference || view == View::signedDifference; }

// The first column right of the divider in an image of `width` px; `split` is the divider's fraction of the width.
uint32_t dividerColumn(float split, uint32_t width);

struct Sun {
    glm::vec3 direction{0.35f, -1.0f, 0.25f};  // direction of the light, world; any length
    glm::vec3 radiance{6.0f, 5.6f, 4.9f};      // linear; pi times the radiance that a white diffuse surface facing the sun reflects
    float diameter = 0.02f;                    // over its distance: a penumbra is 2 cm wide 1 m behind what casts it (the real sun: 0.0093)
    glm::vec3 sky{0.9f, 1.05f, 1.25f};         // ambient radiance from above, linear
    glm::vec3 ground{0.45f, 0.40f, 0.34f};     // ambient radiance from below, linear
};

// The layer of cells that View::voxelSlice shows.
struct VoxelSlice {
    int axis = 1;             // normal of the layer: 0 x, 1 y, 2 z
    std::optional<float> at;  // metres along the axis; empty: at the camera
};

// How depth layers are drawn (layers.h). `best`: for thickness alone, one peel; for two layers, three peels or the ladder, whichever was
// faster in the first frames on this device (peels if fragment shaders cannot write). For two layers the images are the same to the bit.
// On lavapipe at 640x360, atrium / Sponza: one peel 42 / 49 ms, three peels 130 / 150 ms, ladder 77 / 100 ms.
enum class LayerForm : uint8_t { best, peeling, ladder };

enum class Antialiasing : uint8_t { none, temporal };

struct FrameOptions {
    VkExtent2D visible{1280, 720};  // px
    float guard = 0.1f;             // fraction of each side, 0 to 0.5
    scene::Camera camera;
    float time = 0.0f;                   // seconds, of the world's animations
    const ao::Values* method = nullptr;  // method and parameters; never null
    ao::Falloff falloff;
    // Optional method B to compare with `method`, A: same frame and falloff, its own history. A is shown left of the divider, B right of
    // it; the names of their passes get the prefixes "A." and "B.".
    const ao::Values* compare = nullptr;
    float split = 0.5f;             // position of the divider, fraction of the width
    float differenceRange = 0.25f;  // difference of visibility at which the difference views saturate
    View view = View::final;
    std::string passView;     // for View::pass
    uint32_t sampleStep = 0;  // px between samples of Outputs::samples; 0: none
    LayerForm layerForm = LayerForm::best;
    // Ambient light is taken from the bent normals, and blocked reflections from their cone, where the methods of both sides have them.
    bool bentNormals = false;
    // temporal: the projection moves by a fraction of a pixel each frame, and the final picture is the mean over frames. Views other than
    // `final`, and frames with samples, are not moved.
    Antialiasing antialiasing = Antialiasing::none;
    Voxelization voxels;  // for methods that need a volume
    VoxelSlice slice;
    Sun sun;
    float exposure = 1.0f;
    bool cut = false;            // camera cut: history is discarded, motion is 0
    bool skipMasked = false;     // do not draw alpha-masked primitives (as in stored references)
    bool cull = true;            // frustum culling, guard band included
    uint32_t shadowSize = 2048;  // texels per side
    float shadowReach = 40.0f;   // metres around the camera that have shadows, in larger worlds
};

struct Outputs {
    graph::ImageId color;       // the image of `view`: R8G8B8A8_UNORM, sRGB-encoded where it is a colour, visible size
    graph::ImageId visibility;  // R16F, visible size: of the method, or of A and B on their sides of the divider
    // As ao::Library::Added's, of the method, or of A and B on their sides. Only if their values or FrameOptions ask, and both have them.
    graph::ImageId bentNormals;
    graph::ImageId sides[2];  // R16F, visible size: of A and of B alone; the latter only with `compare`
    // Data of every sampleStep-th visible pixel, at (i + 1/2) sampleStep px: half floats of A's and B's visibility, linear depth as float
    // bits, packed normal, half floats of motion in px. R32G32B32A32_UINT, size / sampleStep. Only with `sampleStep`.
    graph::ImageId samples;
    // Guard band included:
    graph::ImageId depth;        // D32, reversed infinite device depth
    graph::ImageId linearDepth;  // R32F, -z in metres; sky: ao's sky value
    graph::ImageId normals;      // R32UI, packNormal(): geometric, eye space
    graph::ImageId motion;       // RG16F, px to last frame's position
    graph::BufferId voxels;      // bits of the volume, shared/volume.h; only if the method reads it
    ao::LayerInputs layers;      // R16F and RG32F, see obscura/ao.h; none unless the method reads them
};

struct SceneFacts {
    size_t triangles = 0, drawn = 0, instances = 0, draws = 0;  // drawn: after culling
    uint64_t textureBytes = 0, geometryBytes = 0;
};

class Renderer {
public:
    // Null, with a log line, if a Vulkan object cannot be created.
    static std::unique_ptr<Renderer> create(gpu::Device& device, const gpu::ShaderLibrary& shaders);
    ~Renderer();

    // Uploads the world's models that are not on the GPU and frees unused ones. add() does this too; call load() ahead to avoid a slow
    // frame. A model that cannot be uploaded is logged and not drawn.
    gpu::Status load(const scene::World& world);

    // Adds the frame's passes. Stores poses and camera for the next frame's motion vectors.
    Outputs add(graph::Graph& graph, const scene::World& world, const FrameOptions& options);

    ao::Library& library();
    ao::Library& otherLibrary();          // of B; created at first use
    SceneFacts facts() const;             // of the last add()
    const voxel::Voxels* voxels() const;  // null until a method has needed a volume

private:
    Renderer();
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

std::span<const gpu::EmbeddedShader> shaders();

}  // namespace obscura::render
