// Scalable ambient obscurance [McGuire, Mara, Luebke: Scalable Ambient Obscurance, HPG 2012]; a baseline method. Samples lie on a spiral of
// 7 turns around the pixel; distant ones read coarser depths, so the cost does not grow with the radius. With v from the pixel to a
// sample,
//     A = 5 sigma / (s r^6) sum over samples of max(0, r^2 - v.v)^3 max(0, (v.n - b) / (v.v + e)),  b = e = 0.01
// Its falloff is (1 - (d/r)^2)^3, of integral 16/35 r; r is chosen so that this equals the integral of the shared falloff. Pixels of
// similar depth are blurred by a mean of 2x2, then along rows and columns with a stride of 2 px.
//
// Differences: normals are the frame's, not derivatives of depth; 5 depth levels instead of up to 6. The preset `tuned` changes
// `sigma` and `radius_scale` and blurs along the surface.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: depths, spiral, blur twice.
#include <iterator>

#include "ao/denoise.h"
#include "ao/depth_mips.h"
#include "ao/mean_reach.h"
#include "ao/scalable/constants.h"

namespace obscura::ao::scalable {
namespace {

constexpr float kOwnReach = 16.0f / 35.0f;  // integral of the method's falloff, in radii

enum Blur : uint32_t { kNone, kRowsAndColumns, kSurface };
const char* const kBlurs[] = {"none", "depth", "surface"};
const Parameter kParameters[] = {
    {"samples", "", 1, 100, 9, true, {}, "Samples on the spiral. Cost grows with them. Too few: noise."},
    {"turns", "", 1, 64, 7, true, {}, "Turns of the spiral. Use a prime number, so that samples do not line up into bands."},
    {"sigma", "m", 0, 1000, 1, false, {},
        "Strength of obscurance, sigma; a length, because the published sum is one over a length. Too low: too bright; too high: creases "
        "turn black."},
    {"radius_scale", "", 0.1f, 4, 1, false, {},
        "Factor on the radius, which matches the falloff at 1. Too low: only contact shadows are left; too high: small creases are "
        "missed."},
    {"bias", "m", 0, 100, 0.01f, false, {},
        "Samples lower than this above the tangent plane are ignored. Too low: facets of curved meshes darken; too high: contact shadows "
        "are lost."},
    {"denoise", "", 0, 2, 1, true, {kBlurs, 3},
        "Blur that removes the noise: rows and columns of similar depth, as published, or 5x5 weighted by depth and normal. None: noise "
        "shows; by depth: it stays on slanted surfaces."},
};
const Setting kDense[] = {{"samples", 32}, {"turns", 17}};
const Setting kTuned[] = {{"samples", 18}, {"sigma", 0.4f}, {"radius_scale", 0.7f}, {"denoise", kSurface}};
const Preset kPresets[] = {
    {"default", "9 samples on 7 turns, as published.", {}},
    {"dense", "32 samples on 17 turns.", {kDense, std::size(kDense)}},
    {"tuned", "18 samples, 0.7 of the radius, sigma 0.4 m, blurred along the surface.", {kTuned, std::size(kTuned)}},
};
const MethodInfo kInfo{"scalable", "Scalable ambient obscurance", "McGuire, Mara, Luebke: Scalable Ambient Obscurance, HPG 2012",
    "A few samples on a spiral; distant ones read coarser depth levels.", kDepth | kNormals, {kParameters, std::size(kParameters)},
    {kPresets, std::size(kPresets)}, true};

class Scalable final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind) {
        auto result = std::make_unique<Scalable>();
        for (uint32_t quads = 0; quads < 2; ++quads)
            if (gpu::Program::compute(device, shaders, "ao/scalable/spiral.comp", {{0, quads}}, result->m_spiral[quads]) != gpu::Status::ok)
                return nullptr;
        if (gpu::Program::compute(device, shaders, "ao/scalable/blur.comp", {}, result->m_blur) != gpu::Status::ok) return nullptr;
        if (DepthMips::create(device, shaders, DepthMips::Filter::oneOfFour, result->m_depths) != Status::ok) return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        return result;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const shared::ScalableSpiral constants{
            values.count("samples"), values.count("turns"), radiusOf(inputs, values), values["sigma"], values["bias"]};
        const graph::ImageId depths = m_depths.add(graph, inputs, "scalable.depths");
        graph::ImageId visibility = graph.image("scalable.visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        graph.pass("scalable.spiral", m_spiral[values.count("denoise") == kRowsAndColumns])
            .read(inputs.viewBlock)
            .read(inputs.normals)
            .read(depths)
            .write(visibility)
            .constants(constants)
            .dispatch(visible.x, visible.y);
        if (values.count("denoise") == kSurface) return m_denoise.add(graph, inputs, visibility, "scalable.surface blur");
        for (uint32_t vertical = 0; vertical < (values.count("denoise") == kNone ? 0u : 2u); ++vertical) {
            const graph::ImageId blurred = graph.image("scalable.blur", graph.desc(visibility));
            graph.pass("scalable.blur", m_blur)
                .read(inputs.viewBlock)
                .read(inputs.depth)
                .read(visibility)
                .write(blurred)
                .constants(shared::ScalableBlur{vertical, constants.radius})
                .dispatch(visible.x, visible.y);
            visibility = blurred;
        }
        return visibility;
    }

    Blocking blocking(const Inputs& inputs, const Values& values) const override { return {radiusOf(inputs, values), Blocking::kEndless}; }

private:
    static float radiusOf(const Inputs& inputs, const Values& values) {
        return values["radius_scale"] * meanReach(inputs.falloffDesc) / kOwnReach;
    }

    gpu::Program m_spiral[2], m_blur;  // m_spiral: without and with the mean of 2x2
    DepthMips m_depths;
    Denoise m_denoise;
};

}  // namespace

MethodEntry entry() { return {.info = &kInfo, .create = &Scalable::create, .perFalloff = false}; }

}  // namespace obscura::ao::scalable
