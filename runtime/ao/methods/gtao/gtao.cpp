// Ground-truth ambient occlusion [Jimenez, Wu, Pesce, Jarabo: Practical Real-Time Strategies for Accurate Indirect Occlusion, 2016],
// as published in XeGTAO [Strugar, McCalla 2021]; a baseline method. The hemisphere is cut into slices through the view ray. In each
// slice the projected normal has length L and angle g, and both sides are searched for the horizon, the largest cosine c of an angle to
// the view ray. With h = -acos c and acos c,
//     visibility = 1/N sum over slices of L/4 sum over both sides of (cos g + 2 h sin g - cos(2h - g))        [Jimenez 2016, eq. 7]
// The falloff attenuates a sample at distance d by c = mix(cos(g +- pi/2), its cosine, rho(d)). XeGTAO's constants are fitted to ray
// tracing: the reach is multiplied by 1.457, L becomes mix(L, 1, 0.05), visibility is raised to the power 2.2 and is at least 0.03. Samples
// are denser near the pixel, distant ones read coarser depths, noise is R2 along a Hilbert curve, and a 5x5 blur with edges removes it.
//
// Differences: the falloff is the shared type, stretched by `radius_scale`; `ramp:0.385:1` is XeGTAO's for r = 1 m. Arc cosines are
// exact to 7e-5 (XeGTAO's: 0.01 or worse), depths have 32 bits, and coarse texels cover the pixel at every image size.
//
// `weighting` arcs extends the paper, off by default: each sample that raises the horizon blocks the arc it newly covers, by its own rho,
//     A = 1/N sum over slices and sides, over samples that raise the horizon of rho(d) (arc(h before) - arc(h)),
// and samples in the tangent plane raise nothing; `axis` spaces slices evenly around the view ray. With `depth_layers`, also off by
// default, a sample raises no horizon: it covers the arc from its front to its back in a mask of 32 equal intervals a side (with `horizon`
// the falloff attenuates both ends; endless layers are then as published). It replaces XeGTAO's thin-occluder heuristic.
//
// Bent normals are the published term (shaders/ao/common/bent_normals.glsl) between the same horizons or of the same arcs, without XeGTAO's
// fitted constants.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: depths, horizons, denoise twice.
#include <cmath>
#include <iterator>

#include "ao/denoise.h"
#include "ao/depth_mips.h"
#include "ao/edge_blur.h"
#include "ao/gtao/constants.h"
#include "ao/layer_pass.h"
#include "ao/slices.h"

namespace obscura::ao::gtao {
namespace {

constexpr float kNearRange = 0.75f;  // of depth levels, in reaches: texels nearer than the farthest by more are left out

const char* const kWeightings[] = {"horizon", "arcs"};
const Parameter kParameters[] = {
    kSlices,
    kSliceSteps,
    {"radius_scale", "", 0.3f, 3, 1, false, {},
        "Factor on the falloff's length, which makes up for occluders that samples miss. Too low: too bright; too high: too dark far from "
        "creases."},
    {"weighting", "", 0, 1, 0, true, {kWeightings, 2},
        "How distance reduces a sample: its horizon is mixed towards the hemisphere's edge, as published, or the arc that it newly covers "
        "is weighted by the falloff."},
    kSliceAxis,
    kSliceMipOffset,
    kDepthLayers,
    kSheet,
    kSliceDenoise,
};
// What XeGTAO fitted to ray tracing, for its presets.
constexpr Setting kRadius{"radius_scale", 1.457f}, kPower{"power", 2.2f}, kFloor{"floor", 0.03f};
const Setting kHigh[] = {kRadius, kPower, kFloor};
const Setting kLow[] = {{"slices", 1}, {"steps", 2}, kRadius, kPower, kFloor};
const Setting kMedium[] = {{"slices", 2}, {"steps", 2}, kRadius, kPower, kFloor};
const Setting kUltra[] = {{"slices", 9}, kRadius, kPower, kFloor};
const Setting kTuned[] = {{"slices", 1}, {"steps", 9}, {"weighting", 1}, {"axis", 1}, {"power", 1.3f}};
const Preset kPresets[] = {
    {"default", "3 slices x 3 steps per side: XeGTAO's high.", {kHigh, std::size(kHigh)}},
    {"low", "1 slice x 2 steps: XeGTAO's low.", {kLow, std::size(kLow)}},
    {"medium", "2 slices x 2 steps: XeGTAO's medium.", {kMedium, std::size(kMedium)}},
    {"high", "3 slices x 3 steps: XeGTAO's high.", {kHigh, std::size(kHigh)}},
    {"ultra", "9 slices x 3 steps: XeGTAO's ultra.", {kUltra, std::size(kUltra)}},
    {"tuned", "1 slice x 9 steps, arcs weighted one by one, slices around the view ray.", {kTuned, std::size(kTuned)}},
};
const MethodInfo kInfo{"gtao", "Ground-truth ambient occlusion",
    "Jimenez, Wu, Pesce, Jarabo: Practical Real-Time Strategies for Accurate Indirect Occlusion, 2016; XeGTAO, Strugar, McCalla 2021",
    "Two horizons in each slice through the view ray, integrated in closed form.", kDepth | kNormals, {kParameters, std::size(kParameters)},
    {kPresets, std::size(kPresets)}, true, true};

class Gtao final : public Method {
public:
    template <bool bent> static std::unique_ptr<Method> create(
        gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind falloff) {
        auto result = std::make_unique<Gtao>();
        for (uint32_t arcs = 0; arcs < 2; ++arcs) {
            if (gpu::Program::compute(device, shaders, bent ? "ao/gtao/horizons.comp:BENT" : "ao/gtao/horizons.comp",
                    {{0, arcs}, falloffConstant(falloff)}, result->m_horizons[arcs]) != gpu::Status::ok)
                return nullptr;
            if (gpu::Program::compute(device, shaders,
                    bent ? "ao/gtao/horizons.comp:DEPTH_LAYERS,BENT" : "ao/gtao/horizons.comp:DEPTH_LAYERS",
                    {{0, arcs}, falloffConstant(falloff)}, result->m_layered[arcs]) != gpu::Status::ok)
                return nullptr;
        }
        if (LayerPass::create(device, shaders, result->m_layerPass) != Status::ok) return nullptr;
        if (EdgeBlur::create(device, shaders, result->m_edgeBlur) != Status::ok) return nullptr;
        if (DepthMips::create(device, shaders, DepthMips::Filter::farthest, result->m_depths) != Status::ok) return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        return result;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const shared::GtaoHorizons constants{falloffBlock(stretched(inputs.falloffDesc, values["radius_scale"])), values.count("slices"),
            values.count("steps"), values["mip_offset"], values["power"], values["floor"], values.count("axis")};
        const graph::ImageId layers = m_layerPass.addIfGiven(graph, inputs, values);
        const graph::ImageId depths =
            layers ? inputs.depth : m_depths.add(graph, inputs, "gtao.depths", kNearRange * constants.falloff.reach);
        const graph::ImageId noisy = graph.image("gtao.visibility and edges", {VK_FORMAT_R32_UINT, visible.x, visible.y});
        graph::Pass& pass = graph.pass("gtao.horizons", (layers ? m_layered : m_horizons)[values.count("weighting")]);
        pass.read(inputs.viewBlock).read(inputs.normals).read(depths).write(noisy);
        if (layers) pass.read(layers);
        const auto blur = SliceBlur(values.count("denoise"));
        RawBentNormals bent;
        if (values.bentNormals) pass.write((bent = sliceBent(graph, inputs, "gtao.bent", blur)).image);
        pass.constants(constants).dispatch(visible.x, visible.y);

        const graph::ImageId visibility = m_edgeBlur.add(graph, noisy, blur == SliceBlur::edges, "gtao.denoise");
        return {blur == SliceBlur::surface ? m_denoise.add(graph, inputs, visibility, "gtao.blur") : visibility, bent};
    }

    Blocking blocking(const Inputs& inputs, const Values& values) const override {
        return blockingWithLayers({inputs.falloff.reach * values["radius_scale"], Blocking::kEndless}, inputs, values);
    }

private:
    static Falloff stretched(const Falloff& rho, float factor) { return {rho.kind, rho.length * factor, rho.end * factor}; }

    DepthMips m_depths;
    gpu::Program m_horizons[2], m_layered[2];  // by weighting
    LayerPass m_layerPass;
    EdgeBlur m_edgeBlur;
    Denoise m_denoise;
};

}  // namespace

MethodEntry entry() { return {.info = &kInfo, .create = &Gtao::create<false>, .createBent = &Gtao::create<true>, .appliesPower = true}; }

}  // namespace obscura::ao::gtao
