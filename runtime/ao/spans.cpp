#include "ao/spans.h"

#include "ao/depth_mips.h"

namespace obscura::ao {
namespace {

struct Packing {  // spans.comp
    float sheet;
    uint32_t shift;
};

}  // namespace

Status SpansPass::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, SpansPass& out) {
    gpu::Status status = gpu::Program::compute(device, shaders, "ao/common/spans_one.comp", {{0, 1}}, out.m_one);
    for (uint32_t layers = 1; layers < 3 && status == gpu::Status::ok; ++layers)
        status = gpu::Program::compute(device, shaders, "ao/common/spans.comp", {{0, layers}}, out.m_two[layers - 1]);
    return status == gpu::Status::ok ? Status::ok : Status::shaderError;
}

graph::ImageId SpansPass::add(graph::Graph& graph, const Inputs& inputs, float sheet, Spans spans) {
    const shared::uvec2 size = inputs.view.size;
    const gpu::ImageDesc desc = DepthMips::desc(spans == Spans::one ? VK_FORMAT_R32G32_UINT : VK_FORMAT_R32G32B32A32_UINT, size);
    const bool one = spans == Spans::one, second = inputs.layers.second && !one;
    const graph::ImageId thickness = inputs.layers.thickness, behind = second ? inputs.layers.second : thickness;  // bound, not read
    const Packing packing{sheet, second && graph.desc(behind).width < size.x ? 1u : 0u};
    const graph::ImageId result = graph.image("spans", desc);
    gpu::Program& program = one ? m_one : m_two[second];
    graph.pass("spans", program).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(thickness).read(behind).write(result)
        .constants(packing).dispatch(desc.width, desc.height);
    return result;
}

}  // namespace obscura::ao
