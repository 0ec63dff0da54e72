// Layered obscurance, this project's method: depth layers and a segment bitmask. A depth buffer has the fronts of objects; here their backs
// are rendered too, so thickness is known. N slices of the hemisphere contain the pixel's view ray, evenly spaced in azimuth. On each side
// of a slice there are M samples, each for one stratum of the distance out to the falloff's reach. A sample's texel holds one or two layers
// [front, back] along its view ray. They are extended over the stratum in the texel's tangent plane (a short way, or, if the previous
// sample lies in the same plane, over the whole stratum and back to the previous sample), and cover the angles from fronts to backs. Each
// 32nd of the side's integral is covered at most once, with the falloff of the segment that covers it first:
//     A = 1/N sum over slices and sides of whole/32 * sum over segments of rho * (bits newly covered)
// Bits have equal cosine-weighted solid angle. With a the angle from the view ray v, od the slice's direction across it and c = cos a, the
// integral up to a is
//     1/2 [(n.v)(1 - c^2) + (n.od)(a - c sqrt(1 - c^2))],
// as in GTAO's closed form [Jimenez 2016, eq. 7], but as a function of c, so that no arc cosine is needed: a - c sqrt(1 - c^2) =
// pi/2 - (asin c + c sqrt(1 - c^2)), and the bracket is a polynomial in c to 0.0014.
//
// The falloff's distance is that to the nearest point of a solid (a receiver behind it faces its back), and to the front of open sheets and
// endless layers. Without depth layers everything has an assumed thickness. The default reads the first layer only: half of the layers'
// cost for about a tenth more error. A second layer of half size is assigned to whole pixels when layers are packed. Distant samples
// read coarser levels of the packed texels (ao/common/packed_layers.glsl). Without layers samples read depth and normal directly.
//
// Reads linear depth, normals and depth layers, guard band included; writes visibility of the visible part. Passes: pack layers,
// segments, gather; with a map also upsample. Slices are interleaved over the pixels of a tile; that is the only noise. The gather along
// the surface weights every share equally, which removes more of it than a Gaussian and leaves no tile pattern. With `map` a part of the
// pixels does all this, gathers over its own tiles and is then upsampled along surfaces.
#include <iterator>

#include "ao/interleave.h"
#include "ao/layer_pass.h"
#include "ao/layered/constants.h"

namespace obscura::ao::layered {
namespace {

const Parameter kParameters[] = {
    {"slices", "", 1, 32, 16, true, {}, "Slices of the hemisphere around the view ray. Cost grows with slices x steps. Too few: noise."},
    {"steps", "", 1, 64, 9, true, {},
        "Samples to each side of a slice, each for a stratum out to the falloff's reach. Cost grows with slices x steps. Too few: thin "
        "objects are missed. Raise steps before slices."},
    {kDepthLayers.id, "", 0, 3, 1, true, {kLayerModes, std::size(kLayerModes)}, kDepthLayers.sentence},
    kSheet,
    {"thickness", "m", 0.01f, 1000, 0.25f, false, {},
        "Assumed thickness of everything where no depth layers are read. Too low: light leaks through solid objects; too high: dark halos "
        "around foreground objects."},
    {"max_pixels", "px", 8, 4096, 4096, false, {},
        "Longest reach on the screen. Shorter is faster close to surfaces, where samples are otherwise far apart in memory. Too short: "
        "wide occlusion is lost close up."},
    {"map", "px", 1, 3, 1, true, {},
        "Image pixels per pixel of the map, each way. 2 costs a quarter of 1 and gathers over twice the width. Too high: small objects "
        "lose their occlusion."},
    {kInterleave.id, "", 0, 3, 3, true, {kInterleaves, 4}, kInterleave.sentence},
};
const Setting kFast[] = {{"steps", 11}, {"depth_layers", float(LayerMode::none)}, {"map", 2}};
const Setting kFastest[] = {{"steps", 6}, {"depth_layers", float(LayerMode::none)}, {"map", 3}};
const Setting kBalanced[] = {{"steps", 8}, {"depth_layers", float(LayerMode::none)}};
const Setting kQuality[] = {{"slices", 12}, {"depth_layers", float(LayerMode::second)}, {"interleave", 1}};
const Setting kReference[] = {{"steps", 32}, {"depth_layers", float(LayerMode::second)}, {"interleave", 0}};
const Preset kPresets[] = {
    {"default", "18 samples per pixel, one slice, thickness: one more geometry pass.", {}},
    {"fastest", "12 samples per 3x3 pixels, no depth layers.", {kFastest, std::size(kFastest)}},
    {"fast", "22 samples per 2x2 pixels, no depth layers: everything has the assumed thickness.", {kFast, std::size(kFast)}},
    {"balanced", "16 samples per pixel, no depth layers.", {kBalanced, std::size(kBalanced)}},
    {"quality", "54 samples per pixel, three slices, thickness and a second surface.", {kQuality, std::size(kQuality)}},
    {"reference", "1024 samples per pixel, not interleaved: the limit of what the depth layers can give.",
        {kReference, std::size(kReference)}},
};
const MethodInfo kInfo{"layered", "Layered obscurance", "",
    "Reads depth layers behind the visible surface; samples cover strata of the hemisphere in a bitmask.", kDepth | kNormals,
    {kParameters, std::size(kParameters)}, {kPresets, std::size(kPresets)}};

class Layered final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind falloff) {
        auto result = std::make_unique<Layered>();
        if (LayerPass::create(device, shaders, result->m_layerPass) != Status::ok) return nullptr;
        const struct {
            const char* name;
            gpu::Program* program;
        } programs[] = {{"ao/layered/segments.comp:NO_LAYERS", &result->m_segments[0]},
            {"ao/layered/segments.comp", &result->m_segments[1]}, {"ao/layered/segments.comp:TWO_LAYERS", &result->m_segments[2]},
            {"ao/layered/gather.comp", &result->m_gather[0]}, {"ao/layered/gather.comp:TO_MAP", &result->m_gather[1]}};
        for (const auto& [name, program] : programs)
            if (gpu::Program::compute(device, shaders, name, {falloffConstant(falloff)}, *program) != gpu::Status::ok) return nullptr;
        return result;
    }

    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const uint32_t layers = !inputs.layers.thickness ? 0 : !inputs.layers.second ? 1 : 2;
        const graph::ImageId texels =
            layers == 0 ? inputs.depth
                        : m_layerPass.add(graph, inputs, values["sheet"], layers == 2 ? LayerPass::Layers::two : LayerPass::Layers::one);
        const uint32_t side = tileSide(values), slices = sharedOut(values.count("slices"), side) / (side * side);
        const uint32_t map = values.count("map"), width = (visible.x + map - 1) / map, height = (visible.y + map - 1) / map;
        const shared::LayeredSegments constants{
            inputs.falloff, slices, values.count("steps"), values["max_pixels"], side, map, values["thickness"]};
        graph::ImageId shares = graph.image("layered.shares", {VK_FORMAT_R32G32_UINT, width, height});
        const graph::ImageId visibility = graph.image("layered.visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        graph.pass("layered.segments", m_segments[layers])
            .read(inputs.viewBlock)
            .read(inputs.normals)
            .read(texels)
            .write(shares)
            .constants(constants)
            .dispatch(width, height);
        const shared::LayeredGather tile{map, side / 2, side / 2 * 2 + 1, 0.5f * float(side) + 0.5f}, four{map, 0, 2, 1.0f};
        if (map > 1) {
            const graph::ImageId gathered = graph.image("layered.gathered", {VK_FORMAT_R32G32_UINT, width, height});
            graph.pass("layered.gather", m_gather[1])
                .read(inputs.viewBlock)
                .read(inputs.depth)
                .read(inputs.normals)
                .read(shares)
                .write(gathered)
                .constants(tile)
                .dispatch(width, height);
            shares = gathered;
        }
        graph.pass(map > 1 ? "layered.upsample" : "layered.gather", m_gather[0])
            .read(inputs.viewBlock)
            .read(inputs.depth)
            .read(inputs.normals)
            .read(shares)
            .write(visibility)
            .constants(map > 1 ? four : tile)
            .dispatch(visible.x, visible.y);
        return visibility;
    }

    // Rays behind a layer's back have not been counted.
    Blocking blocking(const Inputs& inputs, const Values& values) const override {
        return blockingWithLayers({Blocking::kEndless, values["thickness"]}, inputs, values);
    }

private:
    LayerPass m_layerPass;
    gpu::Program m_segments[3];  // by layer count
    gpu::Program m_gather[2];    // to image pixels, to map pixels
};

}  // namespace

MethodEntry entry() { return {&kInfo, &Layered::create}; }

}  // namespace obscura::ao::layered
