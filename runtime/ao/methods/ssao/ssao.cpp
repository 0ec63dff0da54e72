// Screen-space ambient occlusion by point samples [Mittring: Finding Next Gen, CryEngine 2, 2007], in its most common form [de Vries:
// LearnOpenGL, SSAO]; a baseline method. N points lie in the hemisphere above the pixel, denser near it. A point is blocked if the depth
// buffer there is nearer than the point by a bias:
//     A = 1/N sum over points of [z buffer <= z point - bias] smoothstep(0, 1, R / |z pixel - z buffer|)
// The smoothstep excludes surfaces far in front. The kernel is rotated about the normal, in one of 16 ways over a 4x4 tile, and a mean of
// 4x4 pixels removes the pattern. Points lie at distance u mix(0.1, 1, v^2) R, u and v uniform in [0,1). An occluder at distance d blocks
// the fraction of points beyond d, a falloff of integral 0.2 R, so R is 5 times the integral of the shared falloff.
// The published random kernel is replaced by a lattice [Roberts 2018].
//
// `kernel` falloff extends this, off by default: the fraction of points beyond d is the falloff rho(d), and directions are
// cosine-weighted, so that points sample the definition of obscurance.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: points, blur.
#include <cmath>
#include <iterator>

#include "ao/common/constants.h"
#include "ao/denoise.h"
#include "ao/mean_reach.h"
#include "ao/ssao/constants.h"

namespace obscura::ao::ssao {
namespace {

constexpr float kOwnReach = 0.2f;  // integral of the published kernel's falloff, in radii

enum Blur : uint32_t { kNone, kBox, kSurface };
const char* const kKernels[] = {"published", "falloff"};
const char* const kBlurs[] = {"none", "box", "surface"};
const Parameter kParameters[] = {
    {"samples", "", 4, 256, 64, true, {}, "Points in the hemisphere. Cost grows with them. Too few: noise."},
    {"kernel", "", 0, 1, 0, true, {kKernels, 2},
        "Distribution of the points: as published, or cosine-weighted with distances that follow the falloff. As published, occluders near "
        "the horizon count too much."},
    {"radius_scale", "", 0.1f, 4, 1, false, {},
        "Factor on the distance of all points. Too low: only contact shadows are left; too high: small creases are missed."},
    {"bias", "m", 0, 100, 0.025f, false, {},
        "How much nearer the depth buffer must be to block a point. Too low: facets of curved meshes darken; too high: contact shadows are "
        "lost."},
    {"denoise", "", 0, 2, 1, true, {kBlurs, 3},
        "Blur that removes the 4x4 noise pattern: a mean of 4x4 pixels, as published, or 5x5 weighted by depth and normal. None: the "
        "pattern shows; the mean blurs across edges."},
};
const Setting kFast[] = {{"samples", 16}};
const Setting kTuned[] = {{"samples", 29}, {"kernel", 1}, {"radius_scale", 0.7f}, {"bias", 0.00262f}, {"denoise", kSurface}};
const Preset kPresets[] = {
    {"default", "64 points, as published.", {}},
    {"fast", "16 points, distributed as published.", {kFast, std::size(kFast)}},
    {"tuned", "29 cosine-weighted points whose distances follow the falloff, blurred along the surface.", {kTuned, std::size(kTuned)}},
};
const MethodInfo kInfo{"ssao", "Screen-space ambient occlusion",
    "Mittring: Finding Next Gen, CryEngine 2, SIGGRAPH 2007 courses; hemisphere form: de Vries, LearnOpenGL",
    "Tests points in the hemisphere against the depth buffer.", kDepth | kNormals, {kParameters, std::size(kParameters)},
    {kPresets, std::size(kPresets)}, true};

// Distance, metres, beyond which the falloff is below u.
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
    const auto lattice = [](uint32_t i, double step) { return float(std::fmod(0.5 + i * step, 1.0)); };
    for (uint32_t i = 0; i < samples; ++i) {
        const float up = 1.0f - (float(i) + 0.5f) / float(samples), z = published ? up : std::sqrt(up), r = std::sqrt(1.0f - z * z);
        const float phi = 6.2831853f * lattice(i, 0.618033989), u = lattice(i, 0.754877666), v = lattice(i, 0.569840291);
        const float length = scale * (published ? meanReach(falloff) / kOwnReach * u * (0.1f + 0.9f * v * v) : distanceOf(falloff, u));
        kernel.push_back({length * r * std::cos(phi), length * r * std::sin(phi), length * z, 0.0f});
    }
    return kernel;
}

class Ssao final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind) {
        auto result = std::make_unique<Ssao>();
        if (gpu::Program::compute(device, shaders, "ao/ssao/points.comp", {}, result->m_points) != gpu::Status::ok) return nullptr;
        if (gpu::Program::compute(device, shaders, "ao/ssao/box.comp", {}, result->m_box) != gpu::Status::ok) return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        return result;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const std::vector<shared::vec4> kernel =
            kernelOf(inputs.falloffDesc, values.count("samples"), values.count("kernel") == 0, values["radius_scale"]);
        const shared::SsaoPoints constants{values.count("samples"), radiusOf(inputs, values), values["bias"]};
        const graph::BufferId points = graph.upload("ssao.kernel", kernel.data(), kernel.size() * sizeof(kernel[0]));
        const graph::ImageId visibility = graph.image("ssao.visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        graph.pass("ssao.points", m_points)
            .read(inputs.viewBlock)
            .read(inputs.depth)
            .read(inputs.normals)
            .read(points)
            .write(visibility)
            .constants(constants)
            .dispatch(visible.x, visible.y);
        if (values.count("denoise") == kSurface) return m_denoise.add(graph, inputs, visibility, "ssao.blur");
        if (values.count("denoise") == kNone) return visibility;
        const graph::ImageId blurred = graph.image("ssao.blur", graph.desc(visibility));
        graph.pass("ssao.blur", m_box)
            .read(visibility)
            .write(blurred)
            .constants(shared::Whole{shared::sizeOf(visible.x, visible.y)})
            .dispatch(visible.x, visible.y);
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

MethodEntry entry() { return {.info = &kInfo, .create = &Ssao::create, .perFalloff = false}; }

}  // namespace obscura::ao::ssao
