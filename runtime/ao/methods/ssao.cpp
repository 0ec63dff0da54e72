// Screen-space ambient occlusion by point samples [Mittring: Finding Next Gen, CryEngine 2, 2007], in the form that is taught and copied
// most [de Vries: LearnOpenGL, SSAO]: to be compared with. N points lie in the hemisphere above the pixel, more of them near it; one is
// blocked when the depth buffer shows something nearer there by a bias:
//     A = 1/N sum over points of [z buffer <= z point - bias] smoothstep(0, 1, R / |z pixel - z buffer|)
// The smoothstep leaves out what stands far in front. The kernel is turned about the normal, one of 16 ways over a 4x4 tile, and the mean
// of 4x4 pixels takes that out. Points lie u mix(0.1, 1, v^2) R from the pixel, u and v even in [0,1): in a direction that is blocked
// from d on they count by the share of points beyond d, which falls like a falloff of mean 0.2 R. So R is 5 times the shared falloff's.
// Published as random numbers, the kernel is a lattice here [Roberts 2018].
//
// `kernel` falloff goes further, off by default: the share of points beyond d is the falloff's rho(d) itself, and directions are
// cosine-weighted: then points are samples of what obscurance is defined by.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: points, blur.
#include <cmath>
#include <iterator>

#include "ao/mean_reach.h"
#include "ao/resolve.h"

namespace obscura::ao {
namespace {

constexpr float kOwnReach = 0.2f;  // mean of the published kernel's falloff, in radii

enum Blur : uint32_t { kNone, kBox, kSurface };
const char* const kKernels[] = {"published", "falloff"};
const char* const kBlurs[] = {"none", "box", "surface"};
const Parameter kParameters[] = {
    {"samples", "", 4, 256, 64, true, {}, "Points in the hemisphere; cost grows with them."},
    {"kernel", "", 0, 1, 0, true, {kKernels, 2}, "How points lie: as published, or cosine-weighted and as far out as the falloff counts."},
    {"radius_scale", "", 0.1f, 4, 1, false, {}, "How much longer all points are drawn out."},
    {"bias", "m", 0, 100, 0.025f, false, {}, "How much nearer the depth buffer must be to block a point; hides facets, loses contact."},
    {"denoise", "", 0, 2, 1, true, {kBlurs, 3}, "Over the 4x4 noise tile: the mean of 4x4 as published, or along the surface."},
};
const Setting kFast[] = {{"samples", 16}};
const Setting kTuned[] = {{"samples", 29}, {"kernel", 1}, {"radius_scale", 0.7f}, {"bias", 0.00262f}, {"denoise", kSurface}};
const Preset kPresets[] = {
    {"default", "64 points as published.", {}},
    {"fast", "16 of them.", {kFast, std::size(kFast)}},
    {"tuned", "29 cosine-weighted points as far out as the falloff counts, blurred along the surface.", {kTuned, std::size(kTuned)}},
};
const MethodInfo kInfo{"ssao",
                       "Screen-space ambient occlusion",
                       "Mittring: Finding Next Gen, CryEngine 2, SIGGRAPH 2007 courses; hemisphere form: de Vries, LearnOpenGL",
                       "Points in the hemisphere that lie behind the depth buffer.",
                       kDepth | kNormals,
                       {kParameters, std::size(kParameters)},
                       {kPresets, std::size(kPresets)},
                       true};

// The distance beyond which a falloff is less than u.
float distanceOf(const Falloff& falloff, float u) {
    float low = 0.0f, high = reach(falloff);
    for (int i = 0; i < 24; ++i) {
        const float middle = 0.5f * (low + high);
        (evaluate(falloff, middle) >= u ? low : high) = middle;
    }
    return low;
}

std::vector<shared::vec4> kernelOf(const Falloff& falloff, uint32_t samples, bool published, float scale) {
    std::vector<shared::vec4> kernel;
    const auto part = [](uint32_t i, double step) { return float(std::fmod(0.5 + i * step, 1.0)); };
    for (uint32_t i = 0; i < samples; ++i) {
        const float up = 1.0f - (float(i) + 0.5f) / float(samples), z = published ? up : std::sqrt(up), r = std::sqrt(1.0f - z * z);
        const float phi = 6.2831853f * part(i, 0.618033989), u = part(i, 0.754877666), v = part(i, 0.569840291);
        const float length = scale * (published ? meanReach(falloff) / kOwnReach * u * (0.1f + 0.9f * v * v) : distanceOf(falloff, u));
        kernel.push_back({length * r * std::cos(phi), length * r * std::sin(phi), length * z, 0.0f});
    }
    return kernel;
}

class Ssao final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders) {
        auto result = std::make_unique<Ssao>();
        if (gpu::Program::compute(device, shaders, "ao/ssao/points.comp", {}, result->m_points) != gpu::Status::ok) return nullptr;
        if (gpu::Program::compute(device, shaders, "ao/ssao/box.comp", {}, result->m_box) != gpu::Status::ok) return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        return result;
    }

    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const std::vector<shared::vec4> kernel = kernelOf(inputs.falloffDesc, values.count("samples"), values.count("kernel") == 0, values["radius_scale"]);
        const struct { uint32_t samples; float radius, bias; } constants{values.count("samples"), radiusOf(inputs, values), values["bias"]};
        const graph::BufferId points = graph.upload("ssao.kernel", kernel.data(), kernel.size() * sizeof(kernel[0]));
        const graph::ImageId visibility = graph.image("ssao.visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        graph.pass("ssao.points", m_points).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(points).write(visibility)
            .constants(constants).dispatch(visible.x, visible.y);
        if (values.count("denoise") == kSurface) return m_denoise.add(graph, inputs, visibility, "ssao.blur");
        if (values.count("denoise") == kNone) return visibility;
        const graph::ImageId blurred = graph.image("ssao.blur", graph.desc(visibility));
        graph.pass("ssao.blur", m_box).read(visibility).write(blurred).dispatch(visible.x, visible.y);
        return blurred;
    }

    Blocking blocking(const Inputs& inputs, const Values& values) const override { return {radiusOf(inputs, values), Blocking::kEndless}; }

private:
    static float radiusOf(const Inputs& inputs, const Values& values) {
        return values["radius_scale"] * (values.count("kernel") ? inputs.falloff.reach : meanReach(inputs.falloffDesc) / kOwnReach);
    }

    gpu::Program m_points, m_box;
    Denoise m_denoise;
};

}  // namespace

MethodEntry ssaoEntry() { return {&kInfo, &Ssao::create}; }

}  // namespace obscura::ao
