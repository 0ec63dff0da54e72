#include "ao/spans.h"

#include "ao/resolve.h"

namespace obscura::ao {
namespace {

struct Packing {  // spans.comp
    float sheet, assumed;
    uint32_t layers, shift;
};

}  // namespace

Status SpansPass::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, SpansPass& out) {
    return gpu::Program::compute(device, shaders, "ao/common/spans.comp", {}, out.m_pack) == gpu::Status::ok ? Status::ok : Status::shaderError;
}

graph::ImageId SpansPass::add(graph::Graph& graph, const Inputs& inputs, float sheet, float assumed) {
    const shared::uvec2 size = inputs.view.size;
    const bool first = bool(inputs.layers.thickness), second = bool(inputs.layers.second);
    const graph::ImageId missing = first && second ? graph::ImageId{} : allOpen(graph, {1, 1}, "spans.nothing");  // bound, not read
    const Packing packing{sheet, assumed, second ? 2u : first ? 1u : 0u, second && graph.desc(inputs.layers.second).width < size.x ? 1u : 0u};
    const graph::ImageId result = graph.image("spans", {VK_FORMAT_R32G32B32A32_UINT, size.x, size.y});
    graph.pass("spans", m_pack).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(first ? inputs.layers.thickness : missing)
        .read(second ? inputs.layers.second : missing).write(result).constants(packing).dispatch(size.x, size.y);
    return result;
}

}  // namespace obscura::ao
