#include "ao/denoise.h"

namespace obscura::ao {

Status Denoise::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Denoise& out) {
    const bool made = gpu::Program::compute(device, shaders, "ao/common/denoise.comp", {{0, 0}}, out.m_blur) == gpu::Status::ok &&
                      gpu::Program::compute(device, shaders, "ao/common/denoise.comp", {{0, 1}}, out.m_strict) == gpu::Status::ok;
    return made ? Status::ok : Status::shaderError;
}

graph::ImageId Denoise::add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const char* passName) {
    const graph::ImageId result = graph.image(passName, graph.desc(visibility));
    graph.pass(passName, inputs.view.temporal ? m_strict : m_blur)
        .read(inputs.viewBlock)
        .read(inputs.depth)
        .read(inputs.normals)
        .read(visibility)
        .write(result)
        .dispatch(inputs.view.visible.x, inputs.view.visible.y);
    return result;
}

}  // namespace obscura::ao
