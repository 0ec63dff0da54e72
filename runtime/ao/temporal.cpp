#include "ao/temporal.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "ao/common/constants.h"

namespace obscura::ao {

Status Temporal::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Temporal& out) {
    for (const uint32_t motion : {0u, 1u})
        for (const uint32_t orthographic : {0u, 1u})
            if (gpu::Program::compute(device, shaders, motion ? "ao/common/temporal.comp" : "ao/common/temporal.comp:CAMERA",
                    {{0, orthographic}}, out.m_reproject[motion][orthographic]) != gpu::Status::ok)
                return Status::shaderError;
    return Status::ok;
}

graph::ImageId Temporal::add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const TemporalSettings& settings,
    graph::History& kept, bool discard, const char* passName) {
    if (settings.history <= 0.0f) {
        graph.onRecorded([&kept] { kept.invalidate(); });  // it would be older than one frame
        return visibility;
    }
    const shared::View &view = inputs.view, &before = inputs.previousView;
    const auto history =
        graph.history(std::string(passName) + " history", {VK_FORMAT_R32G32_UINT, view.visible.x, view.visible.y}, kept, discard);
    const auto centre = [](const shared::View& v) { return shared::vec2{float(v.guard.x) + 0.5f, float(v.guard.y) + 0.5f}; };
    const shared::vec2 now = centre(view), then = centre(before);  // px, of the first texel of each visible part
    const shared::vec4 &u = before.unproject, &p = before.project;
    shared::Reproject constants{};
    static_assert(sizeof(constants.previousFromEye) == sizeof(inputs.previousFromEye));
    std::memcpy(constants.previousFromEye, inputs.previousFromEye, sizeof(inputs.previousFromEye));
    constants.previousUnproject = {u.x, u.y, then.x * u.x + u.z, then.y * u.y + u.w};
    if (inputs.motion) {
        const float x = float(before.size.x) / float(view.size.x), y = float(before.size.y) / float(view.size.y);
        constants.previousTexel = {x, y, (now.x - inputs.jitter[0]) * x + inputs.previousJitter[0] - then.x,
            (now.y - inputs.jitter[1]) * y + inputs.previousJitter[1] - then.y};
        constants.motionScale = {inputs.motionScale[0] * x, inputs.motionScale[1] * y};
    } else {
        constants.previousTexel = {p.x, p.y, p.z - then.x, p.w - then.y};
    }
    constants.previousVisible = before.visible;
    constants.previousOrthographicDepth = before.orthographicDepth;
    constants.history = std::min(settings.history, 0.98f);
    constants.depthTolerance = settings.depthTolerance;
    constants.normalTolerance = settings.normalTolerance;
    constants.clip = settings.clip;
    constants.clipFloor = settings.clipFloor;
    constants.valid = history.valid ? 1 : 0;
    const graph::ImageId result = graph.image(passName, graph.desc(visibility));
    graph::Pass& pass = graph.pass(passName, m_reproject[inputs.motion ? 1 : 0][view.orthographic > 0.5f ? 1 : 0]);
    pass.read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(visibility).read(history.previous).write(result);
    pass.write(history.current);
    if (inputs.motion) pass.read(inputs.motion);
    pass.constants(constants).dispatch(view.visible.x, view.visible.y);
    return result;
}

}  // namespace obscura::ao
