// Volumetric obscurance [Loos, Sloan: Volumetric Obscurance, I3D 2010], by line samples; a baseline method. Obscurance is the occupied
// fraction of a ball around the pixel. A line of sight through the ball is occupied from the depth buffer on, so one fetch gives a line:
//     A = sum over lines of (length behind the depth buffer) / sum over lines of (length in the ball)
// Lines are spaced evenly over the ball's disc, in one of 16 rotations over a 4x4 tile. A plane occupies half of the ball, so the whole
// ball uses 2 A - 1; with a normal, the half above the tangent plane is measured and nothing is subtracted. For the half ball of radius r
// an occluder at distance d has weight 1 - (d/r)^3, a falloff of integral 3/4 r (touching ball: 1 - 4 (d/r)^3 + 3 (d/r)^4 and 0.6 r, r its
// diameter). r is chosen so that this integral equals the shared falloff's.
//
// Difference: lines are the texels' view rays, which diverge, not parallels of the camera's axis, so planes are open under perspective.
// Extensions, off by default: `solid` touching ball [Szirmay-Kalos 2010, Volumetric Ambient Occlusion], which weights directions about by
// their cosine, and a finite `thickness`.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: lines, blur.
#include <cmath>
#include <iterator>

#include "ao/denoise.h"
#include "ao/mean_reach.h"
#include "ao/volumetric/constants.h"

namespace obscura::ao::volumetric {
namespace {

enum Solid : uint32_t { kBall, kHalf, kTouching };
constexpr float kOwnReach[] = {0.75f, 0.75f, 1.2f};  // integral of each ball's falloff, in radii

const char* const kSolids[] = {"ball", "half ball", "touching ball"};
const Parameter kParameters[] = {
    {"lines", "", 1, 64, 9, true, {}, "Lines of sight through the ball. Cost grows with them. Too few: noise."},
    {"solid", "", 0, 2, kHalf, true, {kSolids, 3},
        "Volume that is measured: the ball around the pixel, which needs no normal, its half above the surface, or the ball that touches "
        "the surface there. All cost the same."},
    {"radius_scale", "", 0.1f, 4, 1, false, {},
        "Factor on the ball's radius, which matches the falloff at 1. Too low: only contact shadows are left; too high: small creases are "
        "missed."},
    {"thickness", "m", 0.001f, 1e6f, 1000, false, {},
        "Assumed thickness of everything; endless as published. Too low: light leaks through solid objects; too high: dark halos around "
        "foreground objects."},
    {"denoise", "", 0, 1, 1, true, {},
        "5x5 blur weighted by depth and normal; it removes the 4x4 noise pattern. Off: the pattern shows; on: details of a few pixels "
        "soften."},
};
const Setting kBallAlone[] = {{"solid", kBall}};
const Setting kDense[] = {{"lines", 33}};
const Setting kTuned[] = {{"lines", 16}, {"radius_scale", 0.56f}, {"thickness", 1.36f}};
const Preset kPresets[] = {
    {"default", "9 lines through the half ball above the surface, as published.", {}},
    {"depth_alone", "9 lines through the whole ball; the normal is not used.", {kBallAlone, std::size(kBallAlone)}},
    {"dense", "33 lines.", {kDense, std::size(kDense)}},
    {"tuned", "16 lines, a ball of 0.56 of the radius, surfaces 1.36 m thick.", {kTuned, std::size(kTuned)}},
};
const MethodInfo kInfo{"volumetric", "Volumetric obscurance", "Loos, Sloan: Volumetric Obscurance, I3D 2010",
    "Line samples of how much of a ball around the pixel lies behind the depth buffer.", kDepth | kNormals,
    {kParameters, std::size(kParameters)}, {kPresets, std::size(kPresets)}, true};

class Volumetric final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind) {
        auto result = std::make_unique<Volumetric>();
        if (gpu::Program::compute(device, shaders, "ao/volumetric/lines.comp", {}, result->m_lines) != gpu::Status::ok) return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        return result;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const shared::VolumetricLines constants{values.count("lines"), radiusOf(inputs, values), values["thickness"], values.count("solid"),
            std::abs(inputs.view.project.x) / inputs.view.pixelsPerMetre};
        const graph::ImageId visibility = graph.image("volumetric.visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        graph.pass("volumetric.lines", m_lines)
            .read(inputs.viewBlock)
            .read(inputs.depth)
            .read(inputs.normals)
            .write(visibility)
            .constants(constants)
            .dispatch(visible.x, visible.y);
        return values.count("denoise") ? m_denoise.add(graph, inputs, visibility, "volumetric.blur") : visibility;
    }

    Blocking blocking(const Inputs& inputs, const Values& values) const override { return {radiusOf(inputs, values), values["thickness"]}; }

private:
    static float radiusOf(const Inputs& inputs, const Values& values) {
        return values["radius_scale"] * meanReach(inputs.falloffDesc) / kOwnReach[values.count("solid")];
    }

    gpu::Program m_lines;
    Denoise m_denoise;
};

}  // namespace

MethodEntry entry() { return {.info = &kInfo, .create = &Volumetric::create, .perFalloff = false}; }

}  // namespace obscura::ao::volumetric
