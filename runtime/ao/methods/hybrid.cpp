// Hybrid ambient occlusion by voxelization [Reinbothe, Boubekeur, Alexa 2009, Hybrid Ambient Occlusion]. Rays leave a pixel's surface
// point for a grid of occupied cells, which knows what the screen does not show:
//     A = sum over rays of c rho(t) / sum over rays of c,   c = cos(ray, normal), t the distance to the first set cell met
// on a map of a quarter of the pixels, then joint bilateral upsampling in two passes. What differs from the paper: the sum of
// cosines in place of the count (the paper's 1/n halves full enclosure), the normals' weight w(1 - n.n') in place of w(1 + n.n'),
// which is zero between equal normals, steps that are shifted for each ray, positions that share within a quarter of the reach,
// and distances counted from the pixel's point although rays start a little above it (as to a surface that faces the ray).
//
// Rays spread evenly in the cosine over the cone, by the golden angle around the normal, from noise of the place in the world.
// Reads the volume, linear depth and normals; writes visibility of the visible part. The map's pixels may share out rays (the shared gather).
#include <algorithm>
#include <cmath>
#include <utility>

#include "ao/resolve.h"
#include "ao/upsample.h"

namespace obscura::ao {
namespace {

struct Trace {
    shared::FalloffBlock falloff;
    uint32_t rays, steps, scale;
    float cone, offset, jitter, grain;
    uint32_t side;  // of the interleaving tile
};

constexpr float kGrain = 1.0f;  // cells a side of the noise's

const Parameter kParameters[] = {
    {"rays", "", 8, 128, 21, true, {}, "Rays a pixel of the map; cost grows with rays x steps."},
    {"steps", "", 4, 64, 10, true, {}, "Places looked at along a ray, out to the falloff's reach; fewer miss thin things."},
    {"jitter", "", 0, 1, 1, false, {}, "1: steps are shifted for each ray, noise for the filter to take out; 0: the same for all, as in the paper, which leaves steps in the picture."},
    {"spread", "", 0.1f, 1, 1, false, {}, "Half angle of the rays' cone over 90 degrees; less is sharper and wrong."},
    {"offset", "cells", 0, 8, 1.75f, false, {}, "How far above the surface rays start. A cell that a plane touches ends within sqrt(3) cells of it: below that a surface darkens itself, above it loses contact shadows."},
    {"map", "px", 1, 4, 2, true, {}, "Pixels a map's pixel, each way: 2 traces a quarter of them."},
    kInterleave,
    {"filter", "px", 0, 32, 20, true, {}, "Width of the upsampling filter; 0: the smallest that fills the gaps."},
    {"filter_range", "", 0.01f, 1, 0.31f, false, {}, "Points further apart than this part of the falloff's reach share nothing."},
};
const Setting kPaper[] = {{"rays", 32}, {"steps", 8}, {"jitter", 0}, {"filter", 16}, {"filter_range", 1}};
const Setting kQuality[] = {{"rays", 64}, {"steps", 24}, {"filter", 8}, {"map", 1}};
const Preset kPresets[] = {
    {"default", "21 rays x 10 shifted steps on a quarter-area map, 20-pixel filter.", {}},
    {"paper", "32 rays x 8 equal steps on a quarter-area map, 16-pixel filter; give it a window of 256 cells.", {kPaper, std::size(kPaper)}},
    {"quality", "64 rays x 24 steps at every pixel, 8-pixel filter.", {kQuality, std::size(kQuality)}},
};
const MethodInfo kInfo{"hybrid",
                       "Hybrid ambient occlusion",
                       "Reinbothe, Boubekeur, Alexa: Hybrid Ambient Occlusion, Eurographics 2009 Areas Papers",
                       "Rays through a voxel grid of the world: occluders count that the screen does not show.",
                       kDepth | kNormals | kVolume,
                       {kParameters, std::size(kParameters)},
                       {kPresets, std::size(kPresets)}};

class Hybrid final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders) {
        auto result = std::make_unique<Hybrid>();
        if (gpu::Program::compute(device, shaders, "ao/hybrid/trace.comp", {}, result->m_trace[0]) != gpu::Status::ok) return nullptr;
        if (gpu::Program::compute(device, shaders, "ao/hybrid/trace_nanovdb.comp", {}, result->m_trace[1]) != gpu::Status::ok) return nullptr;
        if (Upsample::create(device, shaders, result->m_upsample) != Status::ok || Gather::create(device, shaders, result->m_gather) != Status::ok) return nullptr;
        return result;
    }

    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        if (!inputs.volume) return open(graph, inputs);
        const auto& visible = inputs.view.visible;
        const uint32_t scale = values.count("map"), side = tileSide(values);
        const uint32_t width = (visible.x + scale - 1) / scale, height = (visible.y + scale - 1) / scale;
        graph::ImageId map = graph.image("hybrid.map", {VK_FORMAT_R16_SFLOAT, width, height});
        const graph::ImageId receivers = graph.image("hybrid.receivers", {VK_FORMAT_R32G32_UINT, width, height});
        const Trace trace{inputs.falloff, sharedOut(values.count("rays"), side), values.count("steps"), scale, std::cos(values["spread"] * 1.5707963f), values["offset"],
                          values["jitter"], kGrain, side};
        graph.pass("hybrid.trace", m_trace[size_t(inputs.volume.structure)]).read(inputs.viewBlock).read(inputs.volume.block).read(inputs.volume.bits)
            .read(inputs.depth).read(inputs.normals).write(map).write(receivers).constants(trace).dispatch(width, height);
        if (side > 1) map = m_gather.addMap(graph, inputs, map, receivers, scale, side);
        if (scale == 1 && values["filter"] < 1.0f) return map;

        const UpsampleSettings upsample{scale, std::max(values["filter"], 2.0f * float(scale)), values["filter_range"] * inputs.falloff.reach};
        return m_upsample.add(graph, inputs, {map, receivers}, upsample, "hybrid");
    }

private:
    graph::ImageId open(graph::Graph& graph, const Inputs& inputs) {
        if (!std::exchange(m_said, true)) graph.device().log(gpu::Severity::warning, "hybrid: the frame brings no volume, so nothing is blocked");
        return allOpen(graph, {inputs.view.visible.x, inputs.view.visible.y}, "hybrid.open");
    }

    gpu::Program m_trace[2];  // by structure
    Upsample m_upsample;
    Gather m_gather;
    bool m_said = false;
};

}  // namespace

MethodEntry hybridEntry() { return {&kInfo, &Hybrid::create}; }

}  // namespace obscura::ao
