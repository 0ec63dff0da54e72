// Volumetric obscurance [Loos, Sloan: Volumetric Obscurance, I3D 2010], by line samples: to be compared with. How much of a ball around the
// pixel is occupied? The depth buffer says for each line of sight through the ball from where on, so that one fetch tells of a whole line:
//     A = sum over lines of (their part behind the depth buffer) / sum over lines of (their part in the ball)
// Lines lie evenly over the ball's disc, turned one of 16 ways over a 4x4 tile. Of the whole ball a plane occupies half, so A = 2 A - 1;
// with the normal the half above the tangent plane is taken and nothing is subtracted. Half a ball of radius r in a direction that is
// blocked from d on counts by 1 - (d/r)^3, a falloff of mean 3/4 r (the touching ball 1 - 4 (d/r)^3 + 3 (d/r)^4 and 0.6, r its
// diameter): r is chosen so that the mean is the shared falloff's.
//
// Difference: lines are the view rays of texels, which widen, not parallels of the camera's axis: planes are open under perspective. `solid`
// touching ball [Szirmay-Kalos 2010, Volumetric Ambient Occlusion] weighs directions by about their cosine, and `thickness` lets light pass
// behind things; both go further and are off by default.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: lines, blur.
#include <iterator>

#include "ao/mean_reach.h"
#include "ao/resolve.h"

namespace obscura::ao {
namespace {

enum Solid : uint32_t { kBall, kHalf, kTouching };
constexpr float kOwnReach[] = {0.75f, 0.75f, 1.2f};  // mean of the falloff that a ball is, in radii

const char* const kSolids[] = {"ball", "half ball", "touching ball"};
const Parameter kParameters[] = {
    {"lines", "", 1, 64, 9, true, {}, "Lines of sight through the ball; cost grows with them."},
    {"solid", "", 0, 2, kHalf, true, {kSolids, 3}, "What is measured: the ball around the pixel, which needs no normal, its half above the surface, or the ball that touches the surface there."},
    {"radius_scale", "", 0.1f, 4, 1, false, {}, "How much larger the ball is than the falloff asks for."},
    {"thickness", "m", 0.001f, 1e6f, 1000, false, {}, "How thick everything is taken to be; as good as endless as published."},
    {"denoise", "", 0, 1, 1, true, {}, "Depth- and normal-aware 5x5 blur over the 4x4 noise tile."},
};
const Setting kBallAlone[] = {{"solid", kBall}};
const Setting kDense[] = {{"lines", 33}};
const Setting kTuned[] = {{"lines", 16}, {"radius_scale", 0.56f}, {"thickness", 1.36f}};
const Preset kPresets[] = {
    {"default", "9 lines as published, through the half ball above the surface.", {}},
    {"depth_alone", "9 lines through the whole ball: no normals.", {kBallAlone, std::size(kBallAlone)}},
    {"dense", "33 lines.", {kDense, std::size(kDense)}},
    {"tuned", "16 lines, a smaller ball, a metre and a third thick.", {kTuned, std::size(kTuned)}},
};
const MethodInfo kInfo{"volumetric",
                       "Volumetric obscurance",
                       "Loos, Sloan: Volumetric Obscurance, I3D 2010",
                       "How much of a ball around the pixel lies behind the depth buffer, line by line.",
                       kDepth | kNormals,
                       {kParameters, std::size(kParameters)},
                       {kPresets, std::size(kPresets)},
                       true};

class Volumetric final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders) {
        auto result = std::make_unique<Volumetric>();
        if (gpu::Program::compute(device, shaders, "ao/volumetric/lines.comp", {}, result->m_lines) != gpu::Status::ok) return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        return result;
    }

    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const struct { uint32_t lines; float radius, thickness; uint32_t solid; } constants{values.count("lines"), radiusOf(inputs, values), values["thickness"],
                                                                                           values.count("solid")};
        const graph::ImageId visibility = graph.image("volumetric.visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        graph.pass("volumetric.lines", m_lines).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).write(visibility)
            .constants(constants).dispatch(visible.x, visible.y);
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

MethodEntry volumetricEntry() { return {&kInfo, &Volumetric::create}; }

}  // namespace obscura::ao
