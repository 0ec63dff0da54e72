// Layered obscurance, this project's method: depth layers and a segment bitmask. A depth buffer has the fronts of objects; here their backs
// are rendered too, so thickness is known. N slices of the hemisphere contain the pixel's view ray, evenly spaced in azimuth. On each side
// of a slice there are M samples, each for one stratum of the distance out to the falloff's reach. A sample's texel holds one or two layers
// [front, back] along its view ray, which cover the angles from front to back. Each 32nd of the side's integral is covered at most once,
// with the falloff at the nearest point of the layer that covers it first:
//     A = 1/N sum over slices and sides of whole/32 * sum over samples of rho * (bits newly covered)
// Bits have equal cosine-weighted solid angle. With a the angle from the view ray v, od the slice's direction across it and c = cos a, the
// integral up to a is
//     1/2 [(n.v)(1 - c^2) + (n.od)(a - c sqrt(1 - c^2))],
// as in GTAO's closed form [Jimenez 2016, eq. 7], but as a function of c, so that no arc cosine is needed: a - c sqrt(1 - c^2) =
// pi/2 - (asin c + c sqrt(1 - c^2)), and the bracket is a polynomial in c to 0.006.
//
// What lies between samples is covered in two ways. A sample stands for 0.65 of its stratum to each end, as a plate parallel to the image:
// an object narrower than its stratum is rarely hit, and a hit makes up for the misses. And a sample and the one before are joined where
// they can be on one surface: where depth changes by less than the sample's tangent plane allows, or by less than the distance across the
// view. The angles between their fronts are covered too, and the falloff is evaluated at the mean of their distances. Without plates
// occlusion is too weak by 0.02 in a scene like Sponza, without joining by 0.01.
//
// The falloff's distance is that to the nearest point of a solid (a receiver behind it faces its back), and to the front of open sheets and
// endless layers. Without depth layers everything has an assumed thickness. A second layer of half size is assigned to whole pixels when
// layers are packed. Distant samples read coarser levels of the packed texels (ao/common/packed_layers.glsl), except without layers.
//
// Bent normals: newly covered bits count with the mean direction between the cosines that cover them.
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
    {"slices", "", 1, 32, 32, true, {},
        "Slices of the hemisphere around the view ray, shared out over a tile. Cost grows with slices x steps. Too few: noise."},
    {"steps", "", 1, 64, 12, true, {},
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
const Setting kLow[] = {{"slices", 8}, {"steps", 9}, {"interleave", 1}, {"map", 3}};
const Setting kMedium[] = {{"slices", 4}, {"steps", 13}, {"interleave", 1}, {"map", 2}};
const Setting kHigh[] = {{"slices", 8}, {"interleave", 1}, {"map", 2}};
const Setting kUltra[] = {{"slices", 8}, {"steps", 22}, {"depth_layers", float(LayerMode::second)}, {"interleave", 1}, {"map", 2}};
const Setting kReference[] = {{"slices", 16}, {"steps", 32}, {"depth_layers", float(LayerMode::second)}, {"interleave", 0}};
const Preset kPresets[] = {
    {"default", "48 samples per pixel, thickness: one more geometry pass. The calmest.", {}},
    {"low", "36 samples per 3x3 pixels, thickness. No dearer on a GPU than XeGTAO's preset of that name, as the three below.",
        {kLow, std::size(kLow)}},
    {"medium", "26 samples per 2x2 pixels, thickness.", {kMedium, std::size(kMedium)}},
    {"high", "48 samples per 2x2 pixels, thickness.", {kHigh, std::size(kHigh)}},
    {"ultra", "88 samples per 2x2 pixels, thickness and a second surface.", {kUltra, std::size(kUltra)}},
    {"reference", "1024 samples per pixel, not interleaved: the limit of what the depth layers can give.",
        {kReference, std::size(kReference)}},
};
const MethodInfo kInfo{"layered", "Layered obscurance", "",
    "Reads depth layers behind the visible surface; samples cover strata of the hemisphere in a bitmask.", kDepth | kNormals,
    {kParameters, std::size(kParameters)}, {kPresets, std::size(kPresets)}, false, true};

class Layered final : public Method {
public:
    template <bool bent> static std::unique_ptr<Method> create(
        gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind falloff) {
        auto result = std::make_unique<Layered>();
        if (LayerPass::create(device, shaders, result->m_layerPass) != Status::ok) return nullptr;
        const struct {
            const char* name;
            gpu::Program* program;
        } programs[] = {{bent ? "ao/layered/segments.comp:NO_LAYERS,BENT" : "ao/layered/segments.comp:NO_LAYERS", &result->m_segments[0]},
            {bent ? "ao/layered/segments.comp:BENT" : "ao/layered/segments.comp", &result->m_segments[1]},
            {bent ? "ao/layered/segments.comp:TWO_LAYERS,BENT" : "ao/layered/segments.comp:TWO_LAYERS", &result->m_segments[2]},
            {"ao/layered/gather.comp", &result->m_gather[0]}, {"ao/layered/gather.comp:TO_MAP", &result->m_gather[1]}};
        for (const auto& [name, program] : programs)
            if (gpu::Program::compute(device, shaders, name, {falloffConstant(falloff)}, *program) != gpu::Status::ok) return nullptr;
        return result;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const uint32_t layers = !inputs.layers.thickness ? 0 : !inputs.layers.second ? 1 : 2;
        const graph::ImageId texels =
            layers == 0 ? inputs.depth
                        : m_layerPass.add(graph, inputs, values["sheet"], layers == 2 ? LayerPass::Layers::two : LayerPass::Layers::one);
        const uint32_t side = tileSide(values), slices = sharedOut(values.count("slices"), side) / (side * side);
        const uint32_t map = values.count("map"), width = (visible.x + map - 1) / map, height = (visible.y + map - 1) / map;
        const shared::ivec2 mapSize = shared::sizeOf(width, height);
        const shared::LayeredSegments constants{
            mapSize, inputs.falloff, slices, values.count("steps"), values["max_pixels"], side, map, values["thickness"], 0};
        graph::ImageId shares = graph.image("layered.shares", {VK_FORMAT_R32G32_UINT, width, height});
        const graph::ImageId visibility = graph.image("layered.visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        RawBentNormals bent;
        graph::Pass& pass = graph.pass("layered.segments", m_segments[layers]);
        pass.read(inputs.viewBlock).read(inputs.normals).read(texels).write(shares);
        if (values.bentNormals) pass.write((bent = {rawBentNormals(graph, width, height, "layered.bent"), map, side}).image);
        pass.constants(constants).dispatch(width, height);
        const shared::LayeredGather tile{mapSize, map, side / 2, side / 2 * 2 + 1, 0.5f * float(side) + 0.5f},
            four{mapSize, map, 0, 2, 1.0f};
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
        return {visibility, bent};
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

MethodEntry entry() { return {&kInfo, &Layered::create<false>, &Layered::create<true>}; }

}  // namespace obscura::ao::layered
