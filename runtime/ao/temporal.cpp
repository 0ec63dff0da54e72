#include "ao/temporal.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "ao/common/constants.h"

namespace obscura::ao {

Status Temporal::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Temporal& out) {
    for (const uint32_t orthographic : {0u, 1u})
        if (gpu::Program::compute(device, shaders, "ao/common/temporal.comp", {{0, orthographic}},
                orthographic ? out.m_orthographic : out.m_reproject) != gpu::Status::ok)
            return Status::shaderError;
    return Status::ok;
}

graph::ImageId Temporal::add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const TemporalSettings& settings,
    bool discard, const char* passName) {
    if (!inputs.motion || settings.history <= 0.0f) {
        graph.onRecorded([this] { m_history.invalidate(); });  // it would be older than one frame
        return visibility;
    }
    const shared::uvec2 size = inputs.view.visible;
    const auto history = graph.history(std::string(passName) + " history", {VK_FORMAT_R32G32_UINT, size.x, size.y}, m_history, discard);
    shared::Reproject constants{};
    static_assert(sizeof(constants.previousFromEye) == sizeof(inputs.previousFromEye));
    std::memcpy(constants.previousFromEye, inputs.previousFromEye, sizeof(inputs.previousFromEye));
    constants.motionScale = {inputs.motionScale[0], inputs.motionScale[1]};
    constants.motionOffset = {inputs.motionOffset[0], inputs.motionOffset[1]};
    constants.history = std::min(settings.history, 0.98f);
    constants.depthTolerance = settings.depthTolerance;
    constants.normalTolerance = settings.normalTolerance;
    constants.clip = settings.clip;
    constants.clipFloor = settings.clipFloor;
    constants.valid = history.valid ? 1 : 0;
    const graph::ImageId result = graph.image(passName, graph.desc(visibility));
    graph.pass(passName, inputs.view.orthographic > 0.5f ? m_orthographic : m_reproject)
        .read(inputs.viewBlock)
        .read(inputs.depth)
        .read(inputs.normals)
        .read(inputs.motion)
        .read(visibility)
        .read(history.previous)
        .write(result)
        .write(history.current)
        .constants(constants)
        .dispatch(size.x, size.y);
    return result;
}

}  // namespace obscura::ao
