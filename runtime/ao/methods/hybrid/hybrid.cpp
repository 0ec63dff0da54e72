// Hybrid ambient occlusion by voxelization [Reinbothe, Boubekeur, Alexa 2009, Hybrid Ambient Occlusion]. Rays from the pixel's surface
// point run through a grid of occupied cells, which includes occluders outside the image:
//     A = sum over rays of c rho(t) / sum over rays of c,   c = cos(ray, normal), t the distance to the first set cell
// on a map of a quarter of the pixels, followed by joint bilateral upsampling in two passes. Differences from the paper: division by the
// sum of cosines instead of the count (the paper's 1/n halves full enclosure); normal weight w(1 - n.n') instead of w(1 + n.n'), which is 0
// for equal normals; steps shifted per ray; a filter range of a quarter of the reach; distances measured from the surface point although
// rays start above it (as to a surface that faces the ray).
//
// Bent normals are the mean of the rays, by what is not blocked of each; where rays are taken in a cone narrower than the hemisphere, of
// the cone.
//
// Rays are uniform in the cosine over the cone, at multiples of the golden angle around the normal, with noise fixed in the world.
// Reads the volume, linear depth and normals; writes visibility of the visible part. Rays can be interleaved over the map's pixels.
#include <algorithm>
#include <cmath>
#include <utility>

#include "ao/hybrid/constants.h"
#include "ao/interleave.h"
#include "ao/upsample.h"
#include "ao/view.h"

namespace obscura::ao::hybrid {
namespace {

constexpr float kGrain = 4.0f;  // px, least side of a noise cell

const Parameter kParameters[] = {
    {"rays", "", 8, 128, 21, true, {}, "Rays per pixel of the map. Cost grows with rays x steps. Too few: blotches after upsampling."},
    {"stride", "cells", 0.5f, 8, 2, false, {},
        "Longest step along a ray, in cells of the level that it reads. Cost grows with rays / stride. Too long: thin objects are missed."},
    {"octave", "", 1, 5, 2, true, {},
        "Binary logarithm of the number of steps after which cells and steps double. Cost grows with it at wide reaches. Too low: large "
        "cells near the surface, which darken open places."},
    {"steps", "", 0, 64, 0, true, {},
        "0: steps by stride. Else as many equal steps out to the falloff's reach, all in the finest level that holds them, as in the "
        "paper."},
    {"jitter", "", 0, 1, 1, false, {},
        "1: steps are shifted for each ray; the filter removes the noise. 0: equal steps for all rays, as in the paper, which leave "
        "contours."},
    {"spread", "", 0.1f, 1, 1, false, {},
        "Half angle of the cone of rays, as a fraction of 90 degrees. Less is sharper, but occluders near the horizon are missed."},
    {"offset", "cells", 0, 8, 1.75f, false, {},
        "Distance above the surface at which rays start. Cells that touch a plane end within sqrt(3) = 1.73 cells of it. Too low: surfaces "
        "shadow themselves; too high: contact shadows are lost."},
    {"map", "px", 1, 4, 2, true, {},
        "Image pixels per pixel of the map, each way. 2 costs a quarter of 1. Too high: small objects lose their occlusion."},
    kInterleave,
    {"filter", "px", 0, 32, 20, true, {},
        "Width of the upsampling filter. Cost grows with it. 0: the smallest that fills the gaps. Too low: noise; too high: contact "
        "shadows blur."},
    {"filter_range", "", 0.01f, 1, 0.31f, false, {},
        "Points farther apart than this fraction of the falloff's reach are not averaged. Too low: noise; too high: occlusion bleeds "
        "between surfaces."},
};
const Setting kPaper[] = {{"rays", 32}, {"steps", 8}, {"jitter", 0}, {"filter", 16}, {"filter_range", 1}};
const Setting kQuality[] = {{"rays", 64}, {"stride", 1.5f}, {"octave", 3}, {"filter", 8}, {"map", 1}};
const Preset kPresets[] = {
    {"default", "21 rays, jittered steps of 2 cells that grow with the distance, quarter-area map, 20 px filter.", {}},
    {"paper", "32 rays x 8 equal steps on a quarter-area map, 16 px filter. Use a volume of 256 cells a side.",
        {kPaper, std::size(kPaper)}},
    {"quality", "64 rays, steps of 1.5 cells that grow with the distance, every pixel, 8 px filter.", {kQuality, std::size(kQuality)}},
};
const MethodInfo kInfo{"hybrid", "Hybrid ambient occlusion",
    "Reinbothe, Boubekeur, Alexa: Hybrid Ambient Occlusion, Eurographics 2009 Areas Papers",
    "Rays through a voxel grid of the world, so that occluders outside the image count.", kDepth | kNormals | kVolume,
    {kParameters, std::size(kParameters)}, {kPresets, std::size(kPresets)}, false, true};

class Hybrid final : public Method {
public:
    template <bool bent> static std::unique_ptr<Method> create(
        gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind falloff) {
        auto result = std::make_unique<Hybrid>();
        const char* const programs[] = {bent ? "ao/hybrid/trace.comp:BENT" : "ao/hybrid/trace.comp",
            bent ? "ao/hybrid/trace.comp:VOLUME_NANOVDB,BENT" : "ao/hybrid/trace.comp:VOLUME_NANOVDB"};
        for (size_t i = 0; i < 2; ++i)
            if (gpu::Program::compute(device, shaders, programs[i], {falloffConstant(falloff)}, result->m_trace[i]) != gpu::Status::ok)
                return nullptr;
        if (bent && gpu::Program::compute(device, shaders, "ao/common/no_bent_normals.comp", {}, result->m_noBent) != gpu::Status::ok)
            return nullptr;
        if (Upsample::create(device, shaders, result->m_upsample) != Status::ok ||
            Gather::create(device, shaders, result->m_gather) != Status::ok)
            return nullptr;
        return result;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        if (!inputs.volume) return open(graph, inputs, values.bentNormals);
        const auto& visible = inputs.view.visible;
        const uint32_t scale = values.count("map"), side = tileSide(values);
        const uint32_t width = (visible.x + scale - 1) / scale, height = (visible.y + scale - 1) / scale;
        graph::ImageId map = graph.image("hybrid.map", {VK_FORMAT_R16_SFLOAT, width, height});
        const graph::ImageId receivers = graph.image("hybrid.receivers", {VK_FORMAT_R32G32_UINT, width, height});
        const uint32_t equal = values.count("steps"), octave = values.count("octave");
        const uint32_t steps = equal ? equal : volumeRaySteps(inputs.volume.volume, inputs.falloff.reach, values["stride"], octave);
        const shared::HybridTrace trace{shared::sizeOf(width, height), inputs.falloff, sharedOut(values.count("rays"), side), steps, scale,
            std::cos(values["spread"] * 1.5707963f), values["offset"], values["jitter"], kGrain, side, values["stride"], octave,
            equal ? 1u : 0u};
        graph::Pass& pass = graph.pass("hybrid.trace", m_trace[size_t(inputs.volume.structure)]);
        pass.read(inputs.viewBlock)
            .read(inputs.volume.block)
            .read(inputs.volume.bits)
            .read(inputs.depth)
            .read(inputs.normals)
            .write(map)
            .write(receivers);
        RawBentNormals bent;
        if (values.bentNormals) {
            const uint32_t window =
                std::max(side, values.count("filter") / (2 * scale));  // half as wide as visibility's, which is weighted
            pass.write((bent = {rawBentNormals(graph, width, height, "hybrid.bent"), scale, window}).image);
        }
        pass.constants(trace).dispatch(width, height);
        if (side > 1) map = m_gather.addMap(graph, inputs, map, receivers, scale, side);
        if (scale == 1 && values["filter"] < 1.0f) return {map, bent};

        const UpsampleSettings upsample{
            scale, std::max(values["filter"], 2.0f * float(scale)), values["filter_range"] * inputs.falloff.reach};
        return {m_upsample.add(graph, inputs, {map, receivers}, upsample, "hybrid"), bent};
    }

private:
    MethodOutput open(graph::Graph& graph, const Inputs& inputs, bool bentNormals) {
        if (!std::exchange(m_warned, true))
            graph.device().log(gpu::Severity::warning, "hybrid: the frame has no volume (Frame::volume); visibility is 1 everywhere");
        const graph::ImageId visibility = allOpen(graph, {inputs.view.visible.x, inputs.view.visible.y}, "hybrid.open");
        if (!bentNormals) return visibility;
        const RawBentNormals bent{rawBentNormals(graph, 1, 1, "hybrid.bent"), std::max(inputs.view.visible.x, inputs.view.visible.y), 1};
        graph.pass("hybrid.open", m_noBent).write(bent.image).dispatch(1, 1);
        return {visibility, bent};
    }

    gpu::Program m_trace[2];  // by VolumeStructure
    gpu::Program m_noBent;
    Upsample m_upsample;
    Gather m_gather;
    bool m_warned = false;
};

}  // namespace

MethodEntry entry() { return {&kInfo, &Hybrid::create<false>, &Hybrid::create<true>}; }

}  // namespace obscura::ao::hybrid
