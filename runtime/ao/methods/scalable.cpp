// Scalable ambient obscurance [McGuire, Mara, Luebke: Scalable Ambient Obscurance, HPG 2012]: to be compared with. Samples lie on a spiral of
// 7 turns around the pixel, far ones come from coarser depths so that the cost does not grow with the radius, and each, at v from the
// pixel, counts
//     A = 5 sigma / (s r^6) sum over samples of max(0, r^2 - v.v)^3 max(0, (v.n - b) / (v.v + e)),  b = e = 0.01
// Its falloff is its own, (1 - (d/r)^2)^3, of mean 16/35 r: r is chosen so that the mean is the shared falloff's. The mean of 2x2 pixels, then
// two passes along rows and columns, two apart, blur what does not differ in depth.
//
// Differences: normals are the frame's, not differences of depth; levels are 5 of at most 6. `intensity`, `radius_scale` and the blur along
// the surface are what `tuned` goes further with.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: depths, spiral, blur twice.
#include <iterator>

#include "ao/depth_mips.h"
#include "ao/mean_reach.h"
#include "ao/resolve.h"

namespace obscura::ao {
namespace {

constexpr float kOwnReach = 16.0f / 35.0f;  // mean of the method's falloff, in radii

enum Blur : uint32_t { kNone, kRowsAndColumns, kSurface };
const char* const kBlurs[] = {"none", "depth", "surface"};
const Parameter kParameters[] = {
    {"samples", "", 1, 100, 9, true, {}, "Samples on the spiral; cost grows with them."},
    {"turns", "", 1, 64, 7, true, {}, "Turns of the spiral; prime, so that samples do not line up."},
    {"intensity", "m", 0, 1000, 1, false, {}, "How dark what is blocked becomes, sigma; a length, since the published sum is one over a length."},
    {"radius_scale", "", 0.1f, 4, 1, false, {}, "How much longer the radius is than the falloff asks for."},
    {"bias", "m", 0, 100, 0.01f, false, {}, "How far above the tangent plane a sample must lie; hides facets, loses contact."},
    {"denoise", "", 0, 2, 1, true, {kBlurs, 3}, "Over the noise: rows and columns of equal depth as published, or 5x5 along the surface."},
};
const Setting kDense[] = {{"samples", 32}, {"turns", 17}};
const Setting kTuned[] = {{"samples", 18}, {"intensity", 0.4f}, {"radius_scale", 0.7f}, {"denoise", kSurface}};
const Preset kPresets[] = {
    {"default", "9 samples on 7 turns, as published.", {}},
    {"dense", "32 samples.", {kDense, std::size(kDense)}},
    {"tuned", "18 samples, shorter and lighter, blurred along the surface.", {kTuned, std::size(kTuned)}},
};
const MethodInfo kInfo{"scalable",
                       "Scalable ambient obscurance",
                       "McGuire, Mara, Luebke: Scalable Ambient Obscurance, HPG 2012",
                       "Few samples on a spiral, from coarser depths the farther.",
                       kDepth | kNormals,
                       {kParameters, std::size(kParameters)},
                       {kPresets, std::size(kPresets)},
                       true};

class Scalable final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders) {
        auto result = std::make_unique<Scalable>();
        for (uint32_t quads = 0; quads < 2; ++quads)
            if (gpu::Program::compute(device, shaders, "ao/scalable/spiral.comp", {{0, quads}}, result->m_spiral[quads]) != gpu::Status::ok) return nullptr;
        if (gpu::Program::compute(device, shaders, "ao/scalable/blur.comp", {}, result->m_blur) != gpu::Status::ok) return nullptr;
        if (DepthMips::create(device, shaders, DepthMips::Filter::oneOfFour, result->m_depths) != Status::ok) return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        return result;
    }

    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const struct { uint32_t samples, turns; float radius, intensity, bias; } constants{values.count("samples"), values.count("turns"), radiusOf(inputs, values),
                                                                                          values["intensity"], values["bias"]};
        const graph::ImageId depths = m_depths.add(graph, inputs, "scalable.depths");
        graph::ImageId visibility = graph.image("scalable.visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        graph.pass("scalable.spiral", m_spiral[values.count("denoise") == kRowsAndColumns]).read(inputs.viewBlock).read(inputs.normals).read(depths).write(visibility)
            .constants(constants).dispatch(visible.x, visible.y);
        if (values.count("denoise") == kSurface) return m_denoise.add(graph, inputs, visibility, "scalable.surface blur");
        for (uint32_t vertical = 0; vertical < (values.count("denoise") == kNone ? 0u : 2u); ++vertical) {
            const struct { uint32_t vertical; float radius; } pass{vertical, constants.radius};
            const graph::ImageId blurred = graph.image("scalable.blur", graph.desc(visibility));
            graph.pass("scalable.blur", m_blur).read(inputs.viewBlock).read(inputs.depth).read(visibility).write(blurred)
                .constants(pass).dispatch(visible.x, visible.y);
            visibility = blurred;
        }
        return visibility;
    }

    Blocking blocking(const Inputs& inputs, const Values& values) const override { return {radiusOf(inputs, values), Blocking::kEndless}; }

private:
    static float radiusOf(const Inputs& inputs, const Values& values) { return values["radius_scale"] * meanReach(inputs.falloffDesc) / kOwnReach; }

    gpu::Program m_spiral[2], m_blur;  // the former without and with the mean of 2x2
    DepthMips m_depths;
    Denoise m_denoise;
};

}  // namespace

MethodEntry scalableEntry() { return {&kInfo, &Scalable::create}; }

}  // namespace obscura::ao
