#include "ao/depth_mips.h"

#include "ao/common/constants.h"

namespace obscura::ao {

Status DepthMips::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Filter filter, DepthMips& out) {
    return gpu::Program::compute(device, shaders, "ao/common/depth_mips.comp", {{0, uint32_t(filter)}}, out.m_reduce) == gpu::Status::ok
               ? Status::ok
               : Status::shaderError;
}

gpu::ImageDesc DepthMips::desc(VkFormat format, shared::uvec2 size) {
    const shared::uvec2 level0 = padded(size);
    return {format, level0.x, level0.y + level0.y / 16 * 15};
}

graph::ImageId DepthMips::add(graph::Graph& graph, const Inputs& inputs, const char* passName, float range, float fade) {
    const shared::uvec2 size = inputs.view.size;
    const graph::ImageId mips = graph.image(passName, desc(VK_FORMAT_R32_SFLOAT, size));
    graph.pass(passName, m_reduce)
        .read(inputs.depth)
        .write(mips)
        .constants(shared::DepthMips{shared::sizeOf(size.x, size.y), range, fade})
        .dispatch((size.x + 15) / 16 * 8, (size.y + 15) / 16 * 8);
    return mips;
}

}  // namespace obscura::ao
