#include "ao/spans.h"

#include "ao/depth_mips.h"
#include "ao/resolve.h"

namespace obscura::ao {
namespace {

struct Packing {  // spans.comp
    float sheet, assumed;
    uint32_t shift;
};

}  // namespace

Status SpansPass::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, SpansPass& out) {
    gpu::Status status = gpu::Status::ok;
    for (uint32_t layers = 0; layers < 3 && status == gpu::Status::ok; ++layers) {
        status = gpu::Program::compute(device, shaders, "ao/common/spans.comp", {{0, layers}}, out.m_two[layers]);
        if (status == gpu::Status::ok && layers < 2) status = gpu::Program::compute(device, shaders, "ao/common/spans_one.comp", {{0, layers}}, out.m_one[layers]);
    }
    return status == gpu::Status::ok ? Status::ok : Status::shaderError;
}

graph::ImageId SpansPass::add(graph::Graph& graph, const Inputs& inputs, float sheet, float assumed, Spans spans) {
    const shared::uvec2 size = inputs.view.size;
    const gpu::ImageDesc desc = DepthMips::desc(spans == Spans::one ? VK_FORMAT_R32G32_UINT : VK_FORMAT_R32G32B32A32_UINT, size);
    const bool one = spans == Spans::one, first = bool(inputs.layers.thickness), second = first && inputs.layers.second && !one;
    const graph::ImageId thickness = first ? inputs.layers.thickness : allOpen(graph, {1, 1}, "spans.nothing");  // bound, not read
    const graph::ImageId behind = second ? inputs.layers.second : thickness;
    const Packing packing{sheet, assumed, second && graph.desc(behind).width < size.x ? 1u : 0u};
    const graph::ImageId result = graph.image("spans", desc);
    gpu::Program& program = one ? m_one[first] : m_two[second ? 2 : first];
    graph.pass("spans", program).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(thickness).read(behind).write(result)
        .constants(packing).dispatch(desc.width, desc.height);
    return result;
}

}  // namespace obscura::ao
