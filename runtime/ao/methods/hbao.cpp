// Horizon-based ambient occlusion [Bavoil 2008, Image-Space Horizon-Based Ambient Occlusion]. For each of N directions on
// the screen the horizon angle is raised sample by sample; what it gains counts with the falloff at that sample:
//     A = 1/N sum over directions, sum over samples that raise the horizon of rho(|S-P|) (sin h - sin h_before)
// starting at the tangent plane plus a bias. Two changes to the paper: the falloff is the shared type, and the tangent is
// where the neighbouring view ray meets the tangent plane, which is right under perspective. `axis`, `spacing`,
// `sample_test` and `depth_layers` go further than the paper and are off by default, so that the yardstick stays the published one.
// With depth layers a sample raises no horizon: it covers the sines from its front to its back, of 32 parts each but once.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part; then the shared gather and denoiser.
#include <iterator>

#include "ao/resolve.h"
#include "ao/spans.h"

namespace obscura::ao {
namespace {

struct Constants {
    shared::FalloffBlock falloff;
    uint32_t directions;
    uint32_t steps;
    float bias;       // radians
    float maxPixels;  // reach on the screen, px
    float spacing;
    uint32_t viewAxis;
    uint32_t sampleTest;
    uint32_t side;    // of the interleaving tile
};

const char* const kAxes[] = {"camera", "view ray"};
const Parameter kParameters[] = {
    {"directions", "", 1, 32, 16, true, {}, "Directions on the screen; cost grows with directions x steps."},
    {"steps", "", 1, 32, 8, true, {}, "Samples along each direction, out to the falloff's reach."},
    {"bias", "deg", 0, 60, 10, false, {}, "Angle above the tangent plane that is ignored; hides faceting, loses shallow creases."},
    {"spacing", "", 0, 1, 0, false, {}, "How samples lie along a direction: 0 evenly as in the paper, 1 quadratically, denser near the pixel."},
    {"axis", "", 0, 1, 0, true, {kAxes, 2}, "What elevations are measured against: the camera's axis as in the paper, or each pixel's own view ray, which is right off the picture's centre."},
    {"sample_test", "", 0, 1, 0, true, {}, "1: a sample must stand above the tangent plane by the bias itself; nearest-texel samples then raise no horizon on a bare plane."},
    {"max_pixels", "px", 8, 4096, 4096, false, {}, "Longest reach on the screen; shorter is kinder to caches and wrong close up."},
    kDepthLayers,
    kSheet,
    kInterleave,
    {"denoise", "", 0, 1, 1, true, {}, "Depth- and normal-aware 5x5 blur over the 4x4 noise tile."},
};
const Setting kFast[] = {{"directions", 8}, {"steps", 4}};
const Setting kTuned[] = {{"directions", 14}, {"bias", 9.74f}, {"spacing", 0.904f}, {"axis", 1}, {"sample_test", 1}};
const Preset kPresets[] = {
    {"default", "16 directions x 8 steps, as in the paper.", {}},
    {"8x4", "A quarter of the samples.", {kFast, 2}},
    {"tuned", "14 x 8, the view ray as axis, samples denser near the pixel, none that the tangent plane rules out.", {kTuned, std::size(kTuned)}},
};
const MethodInfo kInfo{"hbao",
                       "Horizon-based ambient occlusion",
                       "Bavoil, Sainz, Dimitrov: Image-Space Horizon-Based Ambient Occlusion, SIGGRAPH Talks 2008",
                       "Raises a horizon along directions on the screen. The yardstick of the papers.",
                       kDepth | kNormals,
                       {kParameters, std::size(kParameters)},
                       {kPresets, std::size(kPresets)},
                       true};

class Hbao final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders) {
        auto result = std::make_unique<Hbao>();
        if (gpu::Program::compute(device, shaders, "ao/hbao/horizons.comp", {}, result->m_horizons) != gpu::Status::ok) return nullptr;
        if (gpu::Program::compute(device, shaders, "ao/hbao/horizons_layers.comp", {}, result->m_layered) != gpu::Status::ok) return nullptr;
        if (SpansPass::create(device, shaders, result->m_spans) != Status::ok) return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        if (Gather::create(device, shaders, result->m_gather) != Status::ok) return nullptr;
        return result;
    }

    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const uint32_t side = tileSide(values);
        const Constants constants{inputs.falloff, sharedOut(values.count("directions"), side), values.count("steps"), values["bias"] * 0.017453293f, values["max_pixels"],
                                  values["spacing"], values.count("axis"), values.count("sample_test"), side};
        const auto& visible = inputs.view.visible;
        graph::ImageId visibility = graph.image("hbao.visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        const graph::ImageId spans = inputs.layers.thickness ? m_spans.add(graph, inputs, values["sheet"]) : graph::ImageId{};
        graph::Pass& pass = graph.pass("hbao.horizons", spans ? m_layered : m_horizons);
        pass.read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).write(visibility);
        if (spans) pass.read(spans);
        pass.constants(constants).dispatch(visible.x, visible.y);
        if (side > 1) visibility = m_gather.add(graph, inputs, visibility, side);
        return values.count("denoise") ? m_denoise.add(graph, inputs, visibility, "hbao.denoise") : visibility;
    }

    Blocking blocking(const Inputs& inputs, const Values& values) const override { return blockingOfSpans(Method::blocking(inputs, values), inputs, values); }

private:
    gpu::Program m_horizons, m_layered;
    SpansPass m_spans;
    Denoise m_denoise;
    Gather m_gather;
};

}  // namespace

MethodEntry hbaoEntry() { return {&kInfo, &Hbao::create}; }

}  // namespace obscura::ao
