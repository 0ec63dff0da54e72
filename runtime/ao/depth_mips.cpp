#include "ao/depth_mips.h"

namespace obscura::ao {

Status DepthMips::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Filter filter, DepthMips& out) {
    return gpu::Program::compute(device, shaders, "ao/common/depth_mips.comp", {{0, uint32_t(filter)}}, out.m_reduce) == gpu::Status::ok ? Status::ok
                                                                                                                                  : Status::shaderError;
}

graph::ImageId DepthMips::add(graph::Graph& graph, const Inputs& inputs, const char* passName, float range, float fade) {
    const uint32_t width = (inputs.view.size.x + 15) & ~15u, height = (inputs.view.size.y + 15) & ~15u;
    const graph::ImageId mips = graph.image(passName, width > height ? gpu::ImageDesc{VK_FORMAT_R32_SFLOAT, width, height + height / 2}
                                                                         : gpu::ImageDesc{VK_FORMAT_R32_SFLOAT, width + width / 2, height});
    const float constants[] = {range, fade};
    graph.pass(passName, m_reduce).read(inputs.depth).write(mips).constants(constants).dispatch(width / 2, height / 2);
    return mips;
}

}  // namespace obscura::ao
