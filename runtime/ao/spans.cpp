#include "ao/spans.h"

#include "ao/depth_mips.h"

namespace obscura::ao {

Status SpansPass::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, SpansPass& out) {
    gpu::Status status = gpu::Program::compute(device, shaders, "ao/common/spans_one.comp", {{0, 1}}, out.m_one);
    for (uint32_t layers = 1; layers < 3 && status == gpu::Status::ok; ++layers)
        status = gpu::Program::compute(device, shaders, "ao/common/spans.comp", {{0, layers}}, out.m_two[layers - 1]);
    return status == gpu::Status::ok ? Status::ok : Status::shaderError;
}

LayerReading readLayers(graph::Graph& graph, const Inputs& inputs, float sheet, bool onlyFirst) {
    const bool second = inputs.layers.second && !onlyFirst;
    const graph::ImageId thickness = inputs.layers.thickness, behind = second ? inputs.layers.second : thickness;  // bound, not read
    return {{sheet, second && graph.desc(behind).width < inputs.view.size.x ? 1u : 0u}, thickness, behind, second ? 2u : 1u};
}

graph::ImageId SpansPass::add(graph::Graph& graph, const Inputs& inputs, float sheet, Spans spans) {
    const bool one = spans == Spans::one;
    const gpu::ImageDesc desc = DepthMips::desc(one ? VK_FORMAT_R32G32_UINT : VK_FORMAT_R32G32B32A32_UINT, inputs.view.size);
    const LayerReading layers = readLayers(graph, inputs, sheet, one);
    const graph::ImageId result = graph.image("spans", desc);
    graph.pass("spans", one ? m_one : m_two[layers.layers - 1]).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(layers.thickness)
        .read(layers.second).write(result).constants(layers.packing).dispatch(desc.width, desc.height);
    return result;
}

}  // namespace obscura::ao
