#include "ao/controls.h"

#include <algorithm>

#include "ao/common/constants.h"

namespace obscura::ao {

Status Controls::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Controls& out) {
    return gpu::Program::compute(device, shaders, "ao/common/controls.comp", {}, out.m_program) == gpu::Status::ok ? Status::ok
                                                                                                                   : Status::shaderError;
}

graph::ImageId Controls::add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const ControlSettings& settings) {
    if (settings.neutral()) return visibility;
    const bool fades = settings.fadeTo > 0.0f;
    const float width = std::max(settings.fadeTo - settings.fadeFrom, 1e-3f);
    const auto& visible = inputs.view.visible;
    const graph::ImageId result = graph.image("controlled visibility", graph.desc(visibility));
    graph.pass("controls", m_program)
        .read(inputs.viewBlock)
        .read(inputs.depth)
        .read(visibility)
        .write(result)
        .constants(shared::Controls{
            settings.intensity, settings.power, settings.floor, fades ? settings.fadeTo : 1e30f, fades ? 1.0f / width : 1.0f})
        .dispatch(visible.x, visible.y);
    return result;
}

}  // namespace obscura::ao
