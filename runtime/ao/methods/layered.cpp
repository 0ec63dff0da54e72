// Our own method: depth layers and a segment bitmask. A depth buffer shows where things begin; where they end is rendered as
// well, and integrated without guessing. Around the view ray of a pixel, slices of the hemisphere are cut: N of them, evenly
// in azimuth. On each side of a slice M samples stand for whole strata of the way out to the falloff's reach: what a texel
// holds - one or two spans [front, back] of matter along its view ray - is continued over its stratum in the texel's tangent
// plane (a little way; all the way, and back to where the sample before left off, where that one lies in the same plane), covers the
// angles from its fronts to its backs, and each 32nd of the side's integral is covered at most once, with the falloff of what does so first:
//     A = 1/N sum over slices and sides of whole/32 * sum over segments of rho * (bits newly covered)
// A bit is an equal part of the cosine-weighted solid angle. With a the angle from the view ray v, od the slice's direction
// across it and c = cos a, the integral up to a is
//     1/2 [(n.v)(1 - c^2) + (n.od)(a - c sqrt(1 - c^2))],
// as in GTAO's closed form [Jimenez 2016, eq. 7] but told in c, so that no arc cosine is needed: a - c sqrt(1 - c^2) =
// pi/2 - (asin c + c sqrt(1 - c^2)), and the bracket is a polynomial to 0.0014.
//
// Distances are those to the nearest point of a solid's span (a receiver behind a thing sees its back), to the front of
// sheets and endless ones. Without depth layers everything has an assumed thickness; with the first layer alone the second surface is
// left out, which is the default: half of the layers' cost for about a tenth more error. A second layer of half size is resolved to
// whole pixels when surfaces are packed. Samples far from the pixel come from coarser levels of the packed texels
// (ao/common/spans.glsl). Without layers there is nothing to pack: samples read depth and normal.
//
// Reads linear depth, normals and depth layers, guard band included; writes visibility of the visible part. Passes: spans
// (all of it in one texel), segments, gather, with a map upsample. Slices are shared out among the pixels of a tile, and there is no other noise: a gather
// along the surface that weighs each share alike takes more of it out than a bell-shaped blur, and leaves no tile. Where time is
// short, a map of some of the pixels does all this, gathers over its own tiles, and is then shared out along surfaces.
#include <iterator>
#include <string>

#include "ao/resolve.h"
#include "ao/spans.h"

namespace obscura::ao {
namespace {

struct Constants {  // segments.comp
    shared::FalloffBlock falloff;
    uint32_t slices, steps;
    float maxPixels;
    uint32_t side;      // of the interleaving tile
    uint32_t map;       // pixels that one of the parts stands for, each way
    float assumed;      // thickness where there are no layers, metres
};
struct Window {         // gather.glsl
    uint32_t map, before, taps;
    float covers;
};

const Parameter kParameters[] = {
    {"slices", "", 1, 32, 16, true, {}, "Slices of the hemisphere around the view ray; cost grows with slices x steps."},
    {"steps", "", 1, 64, 9, true, {}, "Samples to each side of a slice, each for a stratum out to the falloff's reach. Better raised before slices."},
    {"depth_layers", "", 0, 3, 1, true, {kLayerChoices, std::size(kLayerChoices)}, "What is read of what lies behind the visible surface; each more costs geometry passes."},
    kSheet,
    {"thickness", "m", 0.01f, 1000, 0.25f, false, {}, "How thick everything is taken to be where there are no depth layers."},
    {"max_pixels", "px", 8, 4096, 4096, false, {}, "Longest reach on the screen; shorter is kinder to caches and wrong close up."},
    {"map", "px", 1, 3, 1, true, {}, "Pixels that one of the map stands for, each way: 2 does a quarter of the work and gathers over twice the width."},
    {kInterleave.id, "", 0, 3, 3, true, {kInterleaves, 4}, kInterleave.sentence},
};
const Setting kFast[] = {{"steps", 11}, {"depth_layers", float(LayerUse::none)}, {"map", 2}};
const Setting kFastest[] = {{"steps", 6}, {"depth_layers", float(LayerUse::none)}, {"map", 3}};
const Setting kBalanced[] = {{"steps", 8}, {"depth_layers", float(LayerUse::none)}};
const Setting kQuality[] = {{"slices", 12}, {"depth_layers", float(LayerUse::second)}, {"interleave", 1}};
const Setting kReference[] = {{"steps", 32}, {"depth_layers", float(LayerUse::second)}, {"interleave", 0}};
const Preset kPresets[] = {
    {"default", "18 samples, a slice a pixel, thickness: one more geometry pass.", {}},
    {"fastest", "12 samples for nine pixels and no layers.", {kFastest, std::size(kFastest)}},
    {"fast", "22 samples for four pixels and no layers: everything has the assumed thickness.", {kFast, std::size(kFast)}},
    {"balanced", "16 samples at every pixel, no layers.", {kBalanced, std::size(kBalanced)}},
    {"quality", "54 samples, three slices a pixel, thickness and a second surface.", {kQuality, std::size(kQuality)}},
    {"reference", "1024 samples, nothing shared out: what the layers hold.", {kReference, std::size(kReference)}},
};
const MethodInfo kInfo{"layered",
                       "Layered obscurance",
                       "",
                       "Renders what lies behind the visible surface and covers the hemisphere by whole strata of it.",
                       kDepth | kNormals,
                       {kParameters, std::size(kParameters)},
                       {kPresets, std::size(kPresets)}};

class Layered final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders) {
        auto result = std::make_unique<Layered>();
        if (SpansPass::create(device, shaders, result->m_spans) != Status::ok) return nullptr;
        const struct { const char* name; gpu::Program* program; } programs[] = {
            {"segments_none", &result->m_segments[0]}, {"segments", &result->m_segments[1]}, {"segments_two", &result->m_segments[2]},
            {"gather", &result->m_gather[0]}, {"gather_map", &result->m_gather[1]}};
        for (const auto& [name, program] : programs)
            if (gpu::Program::compute(device, shaders, std::string("ao/layered/") + name + ".comp", {}, *program) != gpu::Status::ok) return nullptr;
        return result;
    }

    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const uint32_t layers = !inputs.layers.thickness ? 0 : !inputs.layers.second ? 1 : 2;
        const graph::ImageId spans = layers == 0 ? inputs.depth : m_spans.add(graph, inputs, values["sheet"], layers == 2 ? SpansPass::Spans::two : SpansPass::Spans::one);
        const uint32_t side = tileSide(values), slices = sharedOut(values.count("slices"), side) / (side * side);
        const uint32_t map = values.count("map"), width = (visible.x + map - 1) / map, height = (visible.y + map - 1) / map;
        const Constants constants{inputs.falloff, slices, values.count("steps"), values["max_pixels"], side, map, values["thickness"]};
        graph::ImageId parts = graph.image("layered.parts", {VK_FORMAT_R32G32_UINT, width, height});
        const graph::ImageId visibility = graph.image("layered.visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        graph.pass("layered.segments", m_segments[layers]).read(inputs.viewBlock).read(inputs.normals).read(spans).write(parts).constants(constants)
            .dispatch(width, height);
        const Window tile{map, side / 2, side / 2 * 2 + 1, 0.5f * float(side) + 0.5f}, four{map, 0, 2, 1.0f};
        if (map > 1) {
            const graph::ImageId gathered = graph.image("layered.gathered", {VK_FORMAT_R32G32_UINT, width, height});
            graph.pass("layered.gather", m_gather[1]).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(parts).write(gathered).constants(tile)
                .dispatch(width, height);
            parts = gathered;
        }
        graph.pass(map > 1 ? "layered.upsample" : "layered.gather", m_gather[0]).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(parts)
            .write(visibility).constants(map > 1 ? four : tile).dispatch(visible.x, visible.y);
        return visibility;
    }

    // Spans end, so what passes behind them has not been counted.
    Blocking blocking(const Inputs& inputs, const Values& values) const override {
        return blockingOfSpans({Blocking::kEndless, values["thickness"]}, inputs, values);
    }

private:
    SpansPass m_spans;
    gpu::Program m_segments[3];  // without layers, of one span, of two
    gpu::Program m_gather[2];    // to pixels, to a map's
};

}  // namespace

MethodEntry layeredEntry() { return {&kInfo, &Layered::create}; }

}  // namespace obscura::ao
