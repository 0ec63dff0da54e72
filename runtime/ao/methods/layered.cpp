// Our own method: depth layers and a segment bitmask. A depth buffer shows where things begin; where they end is rendered as
// well, and integrated without guessing. Around the view ray of a pixel, slices of the hemisphere are cut: N of them, evenly
// in azimuth. On each side of a slice M samples stand for whole strata of the way out to the falloff's reach: what a texel
// holds - one or two spans [front, back] of matter along its view ray - is continued over its stratum in the texel's tangent
// plane (a little way; all the way where the sample before lies in the same plane), covers the angles from its fronts to its
// backs, and each 32nd of the side's integral is covered at most once, with the falloff of what covers it first:
//     A = 1/N sum over slices and sides of whole/32 * sum over segments of rho * (bits newly covered)
// A bit is an equal part of the cosine-weighted solid angle. With a the angle from the view ray v, od the slice's direction
// across it and c = cos a, the integral up to a is
//     1/2 [(n.v)(1 - c^2) + (n.od)(a - c sqrt(1 - c^2))],
// as in GTAO's closed form [Jimenez 2016, eq. 7] but told in c, so that no arc cosine is needed: a - c sqrt(1 - c^2) =
// pi/2 - (asin c + c sqrt(1 - c^2)), and the bracket is a polynomial to 0.0014.
//
// Distances are those to the nearest point of a solid's span (a receiver behind a thing sees its back), to the front of
// sheets and endless ones. Without depth layers everything has an assumed thickness; with the first layer alone the second
// surface is left out; a second layer of half size is resolved to whole pixels when surfaces are packed.
//
// Reads linear depth, normals and depth layers, guard band included; writes visibility of the visible part. Passes: surfaces
// (all of it in one texel), segments, blur.
#include <iterator>

#include "ao/resolve.h"

namespace obscura::ao {
namespace {

struct SurfaceConstants {  // surfaces.comp
    float sheet, assumed;
    uint32_t layers, shift;
};
struct SegmentConstants {  // segments.comp
    shared::FalloffBlock falloff;
    uint32_t slices, steps;
    float maxPixels;
};

const Parameter kParameters[] = {
    {"slices", "", 1, 32, 1, true, {}, "Slices of the hemisphere around the view ray; cost grows with slices x steps."},
    {"steps", "", 1, 64, 9, true, {}, "Samples to each side of a slice, each for a stratum out to the falloff's reach. Better raised before slices."},
    {"depth_layers", "", 0, 3, 2, true, {kLayerChoices, std::size(kLayerChoices)}, "What is read of what lies behind the visible surface; each more costs geometry passes."},
    {"sheet", "m", 0, 10, 0.05f, false, {}, "How thick open surfaces are: those that no back face follows."},
    {"thickness", "m", 0.01f, 1000, 0.5f, false, {}, "How thick everything is taken to be where there are no depth layers."},
    {"max_pixels", "px", 8, 4096, 4096, false, {}, "Longest reach on the screen; shorter is kinder to caches and wrong close up."},
    {"denoise", "", 0, 1, 1, true, {}, "Depth- and normal-aware 5x5 blur over the 4x4 noise tile."},
};
const Setting kFast[] = {{"steps", 4}, {"depth_layers", float(LayerUse::first)}};
const Setting kQuality[] = {{"slices", 3}, {"depth_layers", float(LayerUse::second)}};
const Setting kReference[] = {{"slices", 16}, {"steps", 32}, {"depth_layers", float(LayerUse::second)}, {"denoise", 0}};
const Preset kPresets[] = {
    {"default", "18 samples, thickness and a second surface of half size.", {}},
    {"fast", "8 samples, thickness alone: one more geometry pass.", {kFast, std::size(kFast)}},
    {"quality", "54 samples, thickness and a second surface.", {kQuality, std::size(kQuality)}},
    {"reference", "1024 samples and no blur: what the layers hold.", {kReference, std::size(kReference)}},
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
        if (gpu::Program::compute(device, shaders, "ao/layered/surfaces.comp", {}, result->m_surfaces) != gpu::Status::ok) return nullptr;
        for (uint32_t second = 0; second < 2; ++second)
            if (gpu::Program::compute(device, shaders, "ao/layered/segments.comp", {{0, second}}, result->m_segments[second]) != gpu::Status::ok) return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        return result;
    }

    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& size = inputs.view.size;
        const auto& visible = inputs.view.visible;
        const bool first = bool(inputs.layers.thickness), second = bool(inputs.layers.second);
        const graph::ImageId missing = first && second ? graph::ImageId{} : allOpen(graph, {1, 1}, "layered.nothing");  // bound, not read
        const SurfaceConstants surface{values["sheet"], values["thickness"], second ? 2u : first ? 1u : 0u,
                                       second && graph.desc(inputs.layers.second).width < size.x ? 1u : 0u};
        const graph::ImageId surfaces = graph.image("layered.surfaces", {VK_FORMAT_R32G32B32A32_UINT, size.x, size.y});
        graph.pass("layered.surfaces", m_surfaces).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals)
            .read(first ? inputs.layers.thickness : missing).read(second ? inputs.layers.second : missing).write(surfaces)
            .constants(surface).dispatch(size.x, size.y);

        const SegmentConstants segments{inputs.falloff, values.count("slices"), values.count("steps"), values["max_pixels"]};
        const graph::ImageId visibility = graph.image("layered.visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        graph.pass("layered.segments", m_segments[second]).read(inputs.viewBlock).read(surfaces).write(visibility).constants(segments)
            .dispatch(visible.x, visible.y);
        return values.count("denoise") ? m_denoise.add(graph, inputs, visibility, "layered.blur") : visibility;
    }

    // Spans end, so what passes behind them at more than the usual thickness has not been counted.
    Blocking blocking(const Inputs&, const Values& values) const override { return {Blocking::kEndless, values["thickness"]}; }

private:
    gpu::Program m_surfaces;
    gpu::Program m_segments[2];  // of one span, of two
    Denoise m_denoise;
};

}  // namespace

MethodEntry layeredEntry() { return {&kInfo, &Layered::create}; }

}  // namespace obscura::ao
