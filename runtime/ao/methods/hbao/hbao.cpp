// Horizon-based ambient occlusion [Bavoil 2008, Image-Space Horizon-Based Ambient Occlusion]. For each of N directions on
// the screen samples raise the horizon angle h; each gain is weighted by the falloff at its sample S:
//     A = 1/N sum over directions, sum over samples that raise the horizon of rho(|S-P|) (sin h - sin h_before)
// starting at the tangent plane plus a bias. Two differences from the paper: the falloff is the shared type, and the tangent is found by
// intersecting the neighbouring view ray with the tangent plane, which is exact under perspective. `axis`, `spacing`, `sample_test` and
// `depth_layers` extend the paper; they are off by default, so that the default is the published method.
// Bent normals are GTAO's term of the same horizons (shaders/ao/common/bent_normals.glsl), weighted by the falloff at each sample.
// With depth layers a sample raises no horizon: it covers the sines from its front to its back in a mask of 32 equal intervals.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: horizons, gather, denoise.
#include <iterator>

#include "ao/denoise.h"
#include "ao/hbao/constants.h"
#include "ao/interleave.h"
#include "ao/layer_pass.h"

namespace obscura::ao::hbao {
namespace {

const char* const kAxes[] = {"camera", "view ray"};
const Parameter kParameters[] = {
    {"directions", "", 1, 32, 16, true, {},
        "Directions on the screen along which horizons are searched. Cost grows with directions x steps. Too few: noise, then bands."},
    {"steps", "", 1, 32, 8, true, {},
        "Samples along each direction, out to the falloff's reach. Cost grows with directions x steps. Too few: thin objects are missed."},
    {"bias", "deg", 0, 60, 10, false, {},
        "Samples lower than this angle above the tangent plane are ignored. Too low: facets of curved meshes darken; too high: shallow "
        "creases are lost."},
    {"spacing", "", 0, 1, 0, false, {},
        "Spacing of samples along a direction: 0 even, as in the paper; 1 quadratic, denser near the pixel. Too low: contact shadows "
        "weaken; too high: distant occluders are missed."},
    {"axis", "", 0, 1, 0, true, {kAxes, 2},
        "Axis from which elevations are measured: the camera's, as in the paper, or each pixel's view ray. The camera's is wrong away from "
        "the image centre."},
    {"sample_test", "", 0, 1, 0, true, {},
        "1: a sample counts only if it lies above the tangent plane by the bias itself. 0: flat surfaces darken, because samples are at "
        "the nearest texel."},
    {"max_pixels", "px", 8, 4096, 4096, false, {},
        "Longest reach on the screen. Shorter is faster close to surfaces, where samples are otherwise far apart in memory. Too short: "
        "wide occlusion is lost close up."},
    kDepthLayers,
    kSheet,
    kInterleave,
    {"denoise", "", 0, 1, 1, true, {},
        "5x5 blur weighted by depth and normal; it removes the 4x4 noise pattern. Off: the pattern shows; on: details of a few pixels "
        "soften."},
};
const Setting kFast[] = {{"directions", 8}, {"steps", 4}};
const Setting kTuned[] = {{"directions", 14}, {"bias", 9.74f}, {"spacing", 0.904f}, {"axis", 1}, {"sample_test", 1}};
const Preset kPresets[] = {
    {"default", "16 directions x 8 steps, as in the paper.", {}},
    {"8x4", "8 directions x 4 steps: a quarter of the samples.", {kFast, 2}},
    {"tuned", "14 directions x 8 steps, elevations from the view ray, samples denser near the pixel, tangent-plane test on.",
        {kTuned, std::size(kTuned)}},
};
const MethodInfo kInfo{"hbao", "Horizon-based ambient occlusion",
    "Bavoil, Sainz, Dimitrov: Image-Space Horizon-Based Ambient Occlusion, SIGGRAPH Talks 2008",
    "Searches for the horizon along directions on the screen. The method that most papers compare with.", kDepth | kNormals,
    {kParameters, std::size(kParameters)}, {kPresets, std::size(kPresets)}, true, true};

class Hbao final : public Method {
public:
    template <bool bent> static std::unique_ptr<Method> create(
        gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind falloff) {
        auto result = std::make_unique<Hbao>();
        if (gpu::Program::compute(device, shaders, bent ? "ao/hbao/horizons.comp:BENT" : "ao/hbao/horizons.comp",
                {falloffConstant(falloff)}, result->m_horizons) != gpu::Status::ok)
            return nullptr;
        if (gpu::Program::compute(device, shaders, bent ? "ao/hbao/horizons.comp:DEPTH_LAYERS,BENT" : "ao/hbao/horizons.comp:DEPTH_LAYERS",
                {falloffConstant(falloff)}, result->m_layered) != gpu::Status::ok)
            return nullptr;
        if (LayerPass::create(device, shaders, result->m_layerPass) != Status::ok) return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        if (Gather::create(device, shaders, result->m_gather) != Status::ok) return nullptr;
        return result;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const uint32_t side = tileSide(values);
        const shared::HbaoHorizons constants{inputs.falloff, sharedOut(values.count("directions"), side), values.count("steps"),
            values["bias"] * 0.017453293f, values["max_pixels"], values["spacing"], values.count("axis"), values.count("sample_test"),
            side};
        const auto& visible = inputs.view.visible;
        graph::ImageId visibility = graph.image("hbao.visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        const graph::ImageId layers = m_layerPass.addIfGiven(graph, inputs, values);
        graph::Pass& pass = graph.pass("hbao.horizons", layers ? m_layered : m_horizons);
        pass.read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).write(visibility);
        if (layers) pass.read(layers);
        RawBentNormals bent;
        if (values.bentNormals) {
            const uint32_t window = std::max(side, values.count("denoise") ? 4u : 1u);  // the noise of the denoiser is a 4x4 tile
            pass.write((bent = {rawBentNormals(graph, visible.x, visible.y, "hbao.bent"), 1, window}).image);
        }
        pass.constants(constants).dispatch(visible.x, visible.y);
        if (side > 1) visibility = m_gather.add(graph, inputs, visibility, side);
        return {values.count("denoise") ? m_denoise.add(graph, inputs, visibility, "hbao.denoise") : visibility, bent};
    }

    Blocking blocking(const Inputs& inputs, const Values& values) const override {
        return blockingWithLayers(Method::blocking(inputs, values), inputs, values);
    }

private:
    gpu::Program m_horizons, m_layered;
    LayerPass m_layerPass;
    Denoise m_denoise;
    Gather m_gather;
};

}  // namespace

MethodEntry entry() { return {&kInfo, &Hbao::create<false>, &Hbao::create<true>}; }

}  // namespace obscura::ao::hbao
