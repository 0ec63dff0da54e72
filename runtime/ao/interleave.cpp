#include "ao/interleave.h"

#include "ao/common/constants.h"

namespace obscura::ao {

uint32_t tileSide(const Values& values) { return values.count(kInterleave.id) + 1; }

uint32_t sharedOut(uint32_t directions, uint32_t side) {
    const uint32_t shares = side * side;
    return (directions + shares - 1) / shares * shares;
}

Status Gather::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Gather& out) {
    const bool made = gpu::Program::compute(device, shaders, "ao/common/gather.comp", {{0, 0}}, out.m_equal) == gpu::Status::ok &&
                      gpu::Program::compute(device, shaders, "ao/common/gather.comp", {{0, 1}}, out.m_weighted) == gpu::Status::ok &&
                      gpu::Program::compute(device, shaders, "ao/common/gather_map.comp", {}, out.m_map) == gpu::Status::ok;
    return made ? Status::ok : Status::shaderError;
}

graph::ImageId Gather::add(graph::Graph& graph, const Inputs& inputs, graph::ImageId shares, uint32_t side, graph::ImageId open) {
    const shared::uvec2 size = inputs.view.visible;
    const graph::ImageId result = graph.image("interleave.gather", {VK_FORMAT_R16_SFLOAT, size.x, size.y});
    graph.pass("interleave.gather", open ? m_weighted : m_equal)
        .read(inputs.viewBlock)
        .read(inputs.depth)
        .read(inputs.normals)
        .read(shares)
        .read(open ? open : shares)
        .write(result)
        .constants(shared::Gather{side})
        .dispatch(size.x, size.y);
    return result;
}

graph::ImageId Gather::addMap(
    graph::Graph& graph, const Inputs& inputs, graph::ImageId shares, graph::ImageId receivers, uint32_t scale, uint32_t side) {
    const gpu::ImageDesc desc = graph.desc(shares);
    const graph::ImageId result = graph.image("interleave.gather", desc);
    graph.pass("interleave.gather", m_map)
        .read(inputs.viewBlock)
        .read(receivers)
        .read(shares)
        .read(shares)
        .write(result)
        .constants(shared::GatherMap{shared::sizeOf(desc.width, desc.height), side, float(scale)})
        .dispatch(desc.width, desc.height);
    return result;
}

}  // namespace obscura::ao
