// Horizon-split ambient occlusion [Dimitrov, Bavoil, Sainz: Horizon-Split Ambient Occlusion, I3D 2008 poster]. For each of
// N_d directions around the normal a line starts in the tangent plane and is raised by surfaces in front of it, to an elevation
// of sine H: the horizon. Everything below is blocked, in closed form,
//     O_T = 1/N_d sum over directions of H^2                                                  [eq. 6, without its stray dz]
// and N_n rays test the part above:
//     O_N = 1/N_d sum over directions of (1 - H^2)/N_n sum over rays of V                      [eq. 11]
//
// Differences where the paper is incomplete or wrong:
// - Normal rays divide 1 - H^2 of their own direction [eq. 8-10 use the mean O_T, which counts twice: up to 1 + H^2].
// - Distance: a rise from H to s counts s^2 - H^2 times the mean of the falloffs at its two ends, instead of one falloff
//   for the whole; the falloff is the shared type.
// - Lines start one pixel above the surface [eq. 13: half a pixel]; then every plane has visibility exactly 1.
// - The elevation is that of the point found, a texel's centre, not its projection on the plane of n and t.
// - Normal rays can use voxels instead of the depth buffer (`rays_in`); the off-screen pass then adds nothing. Or depth layers
//   (`depth_layers`), whose backs replace `thickness`.
// - Surfaces have a thickness, one for raising a line and one for blocking a ray: lines and rays farther behind pass
//   [sec. 5 names the problem: figure 13's outliers]. In the paper thickness is endless.
//
// Bent normals: strips that raise a line count with the integral of w (n.w) over them, as H^2 is of n.w, and rays with their direction;
// those of `term` normal rays are of both terms.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: horizons (1 - O_T),
// normal rays (1 - O_N alone, and both), gather when interleaved, blur.
#include <algorithm>
#include <iterator>
#include <utility>

#include "ao/denoise.h"
#include "ao/horizon_split/constants.h"
#include "ao/interleave.h"
#include "ao/layer_pass.h"

namespace obscura::ao::horizon_split {
namespace {

enum Term : uint32_t { kBoth, kHorizon, kNormalRays, kMarching };
enum Blur : uint32_t { kNone, kDepthDeviation, kSurface };
const char* const kTerms[] = {"both", "horizon", "normal rays", "ray marching"};
const char* const kSpaces[] = {"depth", "voxels"};
const char* const kBlurs[] = {"none", "depth", "surface"};

constexpr float kEndlessThickness = 100.0f;  // radii, of which surfaces are endless
const Parameter kParameters[] = {
    {"directions", "", 1, 24, 8, true, {},
        "Directions around the normal, N_d. Cost grows with directions x steps x (1 + normal rays). Too few: noise."},
    {"steps", "", 1, 64, 18, true, {},
        "Samples along each horizon and each normal ray, N_s. Cost grows with them. Too few: thin objects are missed."},
    {"normal_rays", "", 0, 8, 1, true, {},
        "Rays above each horizon, N_n; each costs as much as a horizon. They find occluders that do not touch the surface. 0: such objects "
        "cast no contact shadows."},
    {"rays_in", "", 0, 1, 0, true, {kSpaces, 2},
        "What normal rays are traced through: the depth buffer, or voxels of the world, which include occluders hidden or outside the "
        "image. Voxels need a volume and are no finer than its cells."},
    {"radius", "m", 0, 100, 0, false, {},
        "Radius of influence, R, at most the falloff's reach; 0: that reach. Shorter: denser samples, but wide occlusion is lost."},
    {"thickness", "R", 0.01f, kEndlessThickness, 0.15f, false, {},
        "Thickness of surfaces that block normal rays, in radii; 100: endless, as in the paper. Too low: light leaks through solid "
        "objects; too "
        "high: dark halos around foreground objects."},
    {"horizon_thickness", "R", 0.01f, kEndlessThickness, 0.35f, false, {},
        "Thickness of surfaces that raise a horizon, in radii; 100: endless, as in the paper. Too low: light leaks through solid objects; "
        "too high: "
        "dark halos around foreground objects."},
    {"spacing", "", 0, 1, 0.6f, false, {},
        "Spacing of samples along a line: 0 even, as in the paper; 1 quadratic, denser near the pixel. Too low: contact shadows weaken; "
        "too high: distant occluders are missed."},
    {"offset", "px", 0, 4, 1, false, {},
        "Distance above the surface at which lines start. Below 1: slanted planes shadow themselves; too high: contact shadows are lost."},
    {"jitter", "", 0, 1, 1, false, {}, "Shift of the samples from pixel to pixel, in steps. 0: bands; 1: noise that the blur removes."},
    {"term", "", 0, 3, 0, true, {kTerms, 4},
        "Output: the sum of both terms, one term alone, or rays through the whole hemisphere without a horizon."},
    kDepthLayers,
    kSheet,
    kInterleave,
    {"blur", "", 0, 2, 2, true, {kBlurs, 3},
        "5x5 blur that removes the 4x4 noise pattern: weighted by depth, as in the paper, or by depth and normal. None: the pattern shows; "
        "by depth: it stays on slanted surfaces."},
};
const Setting kPaperFast[] = {{"directions", 6}, {"steps", 9}, {"normal_rays", 0}, {"thickness", kEndlessThickness},
    {"horizon_thickness", kEndlessThickness}, {"spacing", 0}, {"blur", kDepthDeviation}};
const Setting kPaper[] = {{"directions", 7}, {"steps", 12}, {"thickness", kEndlessThickness}, {"horizon_thickness", kEndlessThickness},
    {"spacing", 0}, {"blur", kDepthDeviation}};
const Setting kQuality[] = {{"directions", 18}, {"steps", 25}, {"normal_rays", 2}};
const Preset kPresets[] = {
    {"default", "8 directions x 18 steps, one normal ray.", {}},
    {"paper_fast", "The paper's fast setting: 6 directions x 9 steps, horizons only, even spacing, endless thickness, blur by depth.",
        {kPaperFast, std::size(kPaperFast)}},
    {"paper",
        "The setting of the paper's table 1: 7 directions x 12 steps, one normal ray, even spacing, endless thickness, blur by depth.",
        {kPaper, std::size(kPaper)}},
    {"quality", "18 directions x 25 steps, two normal rays, the paper's highest counts, with our thicknesses, spacing and blur.",
        {kQuality, std::size(kQuality)}},
};
const MethodInfo kInfo{"horizon_split", "Horizon-split ambient occlusion", "Dimitrov, Bavoil, Sainz: Horizon-Split Ambient Occlusion, 2008",
    "Traces horizons around the normal and integrates below them in closed form; rays cover what is above.", kDepth | kNormals,
    {kParameters, std::size(kParameters)}, {kPresets, std::size(kPresets)}, false, true};

// Words of horizons per row of their image: keeps both sides of it within device limits for very wide and very high images.
uint32_t wordColumns(const shared::uvec2& visible) { return visible.x > 8192 ? 1 : visible.y > 4096 ? 6 : 2; }

class HorizonSplit final : public Method {
public:
    template <bool bent> static std::unique_ptr<Method> create(
        gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind falloff) {
        auto result = std::make_unique<HorizonSplit>();
        const struct {
            const char* name;
            gpu::Program* program;
        } programs[] = {{bent ? "ao/horizon_split/horizons.comp:BENT" : "ao/horizon_split/horizons.comp", &result->m_horizons},
            {bent ? "ao/horizon_split/normal_rays.comp:BENT" : "ao/horizon_split/normal_rays.comp", &result->m_normalRays},
            {bent ? "ao/horizon_split/normal_rays_voxels.comp:BENT" : "ao/horizon_split/normal_rays_voxels.comp", &result->m_voxelRays[0]},
            {bent ? "ao/horizon_split/normal_rays_voxels.comp:VOLUME_NANOVDB,BENT"
                  : "ao/horizon_split/normal_rays_voxels.comp:VOLUME_NANOVDB",
                &result->m_voxelRays[1]},
            {bent ? "ao/horizon_split/normal_rays_layers.comp:BENT" : "ao/horizon_split/normal_rays_layers.comp", &result->m_layerRays},
            {"ao/horizon_split/blur.comp", &result->m_blur}};
        for (const auto& [name, program] : programs)
            if (gpu::Program::compute(device, shaders, name, {falloffConstant(falloff)}, *program) != gpu::Status::ok) return nullptr;
        if (LayerPass::create(device, shaders, result->m_layerPass) != Status::ok) return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        if (Gather::create(device, shaders, result->m_gather) != Status::ok) return nullptr;
        return result;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const uint32_t term = values.count("term"), side = tileSide(values);
        const float radius = radiusOf(inputs, values);
        shared::HorizonSplitMarch constants{inputs.falloff, sharedOut(values.count("directions"), side), values.count("steps"),
            values.count("normal_rays"), radius, values["spacing"], values["jitter"], values["offset"],
            thicknessOf(values, "horizon_thickness", radius), thicknessOf(values, "thickness", radius), side};
        if (term == kHorizon) constants.rays = 0;
        if (term == kNormalRays || term == kMarching) constants.rays = std::max(constants.rays, 1u);

        const gpu::ImageDesc picture{VK_FORMAT_R16_SFLOAT, visible.x, visible.y};
        // A word holds four horizons.
        const uint32_t words = constants.rays ? (constants.directions / (side * side) + 3) / 4 : 0, columns = wordColumns(visible);
        const graph::ImageId horizons =
            graph.image("horizon_split.horizon sines", {VK_FORMAT_R32_UINT, words ? visible.x * std::min(words, columns) : 1,
                                                           words ? visible.y * ((words + columns - 1) / columns) : 1});
        graph::ImageId result = graph.image("horizon_split.below horizon", picture);
        shared::HorizonSplitMarch tracing = constants;
        if (term == kMarching) tracing.steps = 0;  // without steps the horizon stays at 0, so rays cover the whole hemisphere
        graph::ImageId bent;
        if (values.bentNormals) bent = rawBentNormals(graph, visible.x, visible.y, "horizon_split.bent");
        graph::Pass& below = graph.pass("horizon_split.horizons", m_horizons);
        below.read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).write(result).write(horizons);
        if (bent) below.write(bent);
        below.constants(tracing).dispatch(visible.x, visible.y);
        const bool inVoxels = values.count("rays_in") && inputs.volume;
        if (values.count("depth_layers") && (!constants.rays || inVoxels) && !std::exchange(m_warnedOfLayers, true))
            graph.device().log(gpu::Severity::warning,
                "horizon_split: depth_layers has no effect without normal rays through the depth buffer, which alone use them");
        if (constants.rays) {
            const graph::ImageId above = graph.image("horizon_split.above horizon", picture),
                                 both = graph.image("horizon_split.visibility", picture);
            const graph::ImageId layers = inVoxels ? graph::ImageId{} : m_layerPass.addIfGiven(graph, inputs, values);
            graph::Pass& pass = graph.pass("horizon_split.normal rays", inVoxels ? m_voxelRays[size_t(inputs.volume.structure)]
                                                                        : layers ? m_layerRays
                                                                                 : m_normalRays);
            pass.read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(result).read(horizons).write(above).write(both);
            if (layers) pass.read(layers);
            if (inVoxels) pass.read(inputs.volume.block).read(inputs.volume.bits);
            if (bent) {
                const graph::ImageId all = rawBentNormals(graph, visible.x, visible.y, "horizon_split.bent");
                pass.read(bent).write(all);
                bent = all;
            }
            if (values.count("rays_in") && !inVoxels && !std::exchange(m_warned, true))
                graph.device().log(gpu::Severity::warning,
                    "horizon_split: the frame has no volume (Frame::volume); normal rays use the depth buffer instead");
            pass.constants(constants).dispatch(visible.x, visible.y);
            result = term == kNormalRays ? above : both;
        }
        if (side > 1) result = m_gather.add(graph, inputs, result, side);
        const uint32_t window = std::max(side, values.count("blur") == kNone ? 1u : 4u);  // the noise is a 4x4 tile
        return {blurred(graph, inputs, result, values.count("blur")), {bent, 1, window}};
    }

    // Everything behind the horizon counts as blocked, although surfaces have a thickness; ray marching alone has no horizon.
    Blocking blocking(const Inputs& inputs, const Values& values) const override {
        const float radius = radiusOf(inputs, values);
        return values.count("term") == kMarching ? Blocking{Blocking::kEndless, thicknessOf(values, "thickness", radius)}
                                                 : Blocking{radius, Blocking::kEndless};
    }

private:
    static float thicknessOf(const Values& values, const char* id, float radius) {
        return values[id] < kEndlessThickness ? values[id] * radius : Blocking::kEndless;
    }
    static float radiusOf(const Inputs& inputs, const Values& values) {
        const float reach = inputs.falloff.reach;
        return values["radius"] > 0.0f ? std::min(values["radius"], reach) : reach;
    }

    graph::ImageId blurred(graph::Graph& graph, const Inputs& inputs, graph::ImageId source, uint32_t blur) {
        if (blur == kNone) return source;
        if (blur == kSurface) return m_denoise.add(graph, inputs, source, "horizon_split.blur");
        const graph::ImageId result = graph.image("horizon_split.blur", graph.desc(source));
        graph.pass("horizon_split.blur", m_blur)
            .read(inputs.viewBlock)
            .read(inputs.depth)
            .read(source)
            .write(result)
            .dispatch(inputs.view.visible.x, inputs.view.visible.y);
        return result;
    }

    gpu::Program m_horizons;
    gpu::Program m_normalRays, m_layerRays, m_voxelRays[2];  // m_voxelRays: by VolumeStructure
    gpu::Program m_blur;
    LayerPass m_layerPass;
    Denoise m_denoise;
    Gather m_gather;
    bool m_warned = false, m_warnedOfLayers = false;
};

}  // namespace

MethodEntry entry() {
    return {&kInfo, &HorizonSplit::create<false>, &HorizonSplit::create<true>,
        [](const Values& values) { return values.count("rays_in") ? uint32_t(kVolume) : 0u; }};
}

}  // namespace obscura::ao::horizon_split
