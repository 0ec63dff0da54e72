// Ground-truth ambient occlusion [Jimenez, Wu, Pesce, Jarabo: Practical Real-Time Strategies for Accurate Indirect Occlusion, 2016],
// as XeGTAO publishes it [Strugar, McCalla 2021]: what others use, to be compared with. The hemisphere is cut into slices through the
// view ray; in each the normal's projection has length L and lies at the angle g, and both sides are searched for the horizon, the
// largest cosine c of an angle to the view ray. With h = -acos c and acos c,
//     visibility = 1/N sum over slices of L/4 sum over both sides of (cos g + 2 h sin g - cos(2h - g))        [Jimenez 2016, eq. 7]
// A sample at distance d counts by mixing: c = mix(cos(g +- pi/2), its cosine, rho(d)). XeGTAO fits rest to ray tracing: the reach is 1.457
// times as long, L is drawn to 1 by a twentieth, the result is raised to 2.2 and is at least 0.03. Samples are denser near the pixel,
// far ones come from coarser depths, noise is R2 along a Hilbert curve, and a 5x5 blur with edges takes it out.
//
// Differences: the falloff is the shared type, stretched by `radius_scale`; `ramp:0.385:1` is XeGTAO's own for r = 1 m. Arc cosines are
// exact to 7e-5 (XeGTAO's to 0.01 and more), depths 32 bits, texels of coarser levels those that hold the pixel at every size.
//
// `weighting` arcs goes further, off by default: each sample that raises the horizon blocks what it newly covers, by its own rho,
//     A = 1/N sum over slices and sides, over samples that raise the horizon of rho(d) (arc(h before) - arc(h)),
// and none does that the tangent plane rules out; `axis` makes slices even around the view ray. With `depth_layers`, off by default too, a
// sample raises no horizon: it covers the arc from its front to its back, 32 parts a side each but once (with `horizon`, both ends are
// mixed; what never ends is then as published). XeGTAO's thin-occluder heuristic, which guesses that end, is not needed.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: depths, horizons, denoise twice.
#include <cmath>
#include <iterator>

#include "ao/depth_mips.h"
#include "ao/edge_blur.h"
#include "ao/resolve.h"
#include "ao/slices.h"
#include "ao/spans.h"

namespace obscura::ao {
namespace {

struct Constants {  // horizons.comp
    shared::FalloffBlock falloff;
    uint32_t slices, steps;
    float mipOffset, power, least;
    uint32_t rayAxis;
};

constexpr float kNearRange = 0.75f;  // of depth levels: what is so many reaches nearer than the farthest is left out

const char* const kWeightings[] = {"horizon", "arcs"};
const Parameter kParameters[] = {
    kSlices,
    kSliceSteps,
    {"radius_scale", "", 0.3f, 3, 1.457f, false, {}, "How much longer the falloff is made, against what samples miss."},
    {"weighting", "", 0, 1, 0, true, {kWeightings, 2}, "How far samples count less: by mixing their horizon as published, or each for the arc that it newly covers."},
    kSliceAxis,
    kSliceMipOffset,
    {"power", "", 0.5f, 5, 2.2f, false, {}, "Visibility is raised to this."},
    {"floor", "", 0, 1, 0.03f, false, {}, "Least visibility."},
    kDepthLayers,
    kSheet,
    kSliceDenoise,
};
const Setting kTuned[] = {{"slices", 1}, {"steps", 9}, {"radius_scale", 1}, {"weighting", 1}, {"axis", 1}, {"power", 1.3f}, {"floor", 0}};
const Preset kPresets[] = {
    {"default", "3 slices x 3 steps a side, XeGTAO's high.", {}},
    {"low", "XeGTAO's low: 1 x 2.", {kSlicesLow, std::size(kSlicesLow)}},
    {"medium", "XeGTAO's medium: 2 x 2.", {kSlicesMedium, std::size(kSlicesMedium)}},
    {"high", "XeGTAO's high: 3 x 3.", {}},
    {"ultra", "XeGTAO's ultra: 9 x 3.", {kSlicesUltra, std::size(kSlicesUltra)}},
    {"tuned", "1 x 9, arcs that count one by one, slices around the view ray.", {kTuned, std::size(kTuned)}},
};
const MethodInfo kInfo{"gtao",
                       "Ground-truth ambient occlusion",
                       "Jimenez, Wu, Pesce, Jarabo: Practical Real-Time Strategies for Accurate Indirect Occlusion, 2016; XeGTAO, Strugar, McCalla 2021",
                       "Horizons of slices through the view ray, integrated in closed form.",
                       kDepth | kNormals,
                       {kParameters, std::size(kParameters)},
                       {kPresets, std::size(kPresets)},
                       true};

class Gtao final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders) {
        auto result = std::make_unique<Gtao>();
        for (uint32_t arcs = 0; arcs < 2; ++arcs) {
            if (gpu::Program::compute(device, shaders, "ao/gtao/horizons.comp", {{0, arcs}}, result->m_horizons[arcs]) != gpu::Status::ok) return nullptr;
            if (gpu::Program::compute(device, shaders, "ao/gtao/horizons_layers.comp", {{0, arcs}}, result->m_layered[arcs]) != gpu::Status::ok) return nullptr;
        }
        if (SpansPass::create(device, shaders, result->m_spans) != Status::ok) return nullptr;
        if (EdgeBlur::create(device, shaders, result->m_edgeBlur) != Status::ok) return nullptr;
        if (DepthMips::create(device, shaders, DepthMips::Filter::farthest, result->m_depths) != Status::ok) return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        return result;
    }

    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const Constants constants{stretched(inputs.falloff, values["radius_scale"]), values.count("slices"), values.count("steps"),
                                  values["mip_offset"], values["power"], values["floor"], values.count("axis")};
        const graph::ImageId spans = inputs.layers.thickness ? m_spans.add(graph, inputs, values["sheet"]) : graph::ImageId{};
        const graph::ImageId depths = spans ? inputs.depth : m_depths.add(graph, inputs, "gtao.depths", kNearRange * constants.falloff.reach);
        const graph::ImageId noisy = graph.image("gtao.visibility and edges", {VK_FORMAT_R32_UINT, visible.x, visible.y});
        graph::Pass& pass = graph.pass("gtao.horizons", (spans ? m_layered : m_horizons)[values.count("weighting")]);
        pass.read(inputs.viewBlock).read(inputs.normals).read(depths).write(noisy);
        if (spans) pass.read(spans);
        pass.constants(constants).dispatch(visible.x, visible.y);

        const auto blur = SliceBlur(values.count("denoise"));
        const graph::ImageId visibility = m_edgeBlur.add(graph, noisy, blur == SliceBlur::edges, "gtao.denoise");
        return blur == SliceBlur::surface ? m_denoise.add(graph, inputs, visibility, "gtao.blur") : visibility;
    }

    Blocking blocking(const Inputs& inputs, const Values& values) const override {
        return blockingOfSpans({inputs.falloff.reach * values["radius_scale"], Blocking::kEndless}, inputs, values);
    }

private:
    static shared::FalloffBlock stretched(shared::FalloffBlock rho, float factor) {
        float power = 1.0f;
        for (float* c : {&rho.c1, &rho.c2, &rho.c3, &rho.c4, &rho.c5}) *c /= power *= factor;
        rho.decay /= factor;
        rho.reach *= factor;
        return rho;
    }

    DepthMips m_depths;
    gpu::Program m_horizons[2], m_layered[2];  // by weighting
    SpansPass m_spans;
    EdgeBlur m_edgeBlur;
    Denoise m_denoise;
};

}  // namespace

MethodEntry gtaoEntry() { return {&kInfo, &Gtao::create}; }

}  // namespace obscura::ao
