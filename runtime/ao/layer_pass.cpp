#include "ao/layer_pass.h"

#include "ao/depth_mips.h"

namespace obscura::ao {

Status LayerPass::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, LayerPass& out) {
    gpu::Status status = gpu::Program::compute(device, shaders, "ao/common/pack_layers.comp:ONE_LAYER", {{0, 1}}, out.m_packFirst);
    for (uint32_t layers = 1; layers < 3 && status == gpu::Status::ok; ++layers)
        status = gpu::Program::compute(device, shaders, "ao/common/pack_layers.comp", {{0, layers}}, out.m_packTwo[layers - 1]);
    return status == gpu::Status::ok ? Status::ok : Status::shaderError;
}

LayerPackInputs layerPackInputs(graph::Graph& graph, const Inputs& inputs, float sheet, bool onlyFirst) {
    const bool second = inputs.layers.second && !onlyFirst;
    const graph::ImageId thickness = inputs.layers.thickness;
    const graph::ImageId behind = second ? inputs.layers.second : thickness;  // without a second layer: bound, not read
    return {{sheet, second && graph.desc(behind).width < inputs.view.size.x ? 1u : 0u}, thickness, behind, second ? 2u : 1u};
}

graph::ImageId LayerPass::add(graph::Graph& graph, const Inputs& inputs, float sheet, Layers layers) {
    const bool one = layers == Layers::one;
    const shared::uvec2 level0 = DepthMips::padded(inputs.view.size);  // every pixel writes all its texels
    const gpu::ImageDesc desc = DepthMips::desc(one ? VK_FORMAT_R32G32_UINT : VK_FORMAT_R32G32B32A32_UINT, inputs.view.size);
    const LayerPackInputs packing = layerPackInputs(graph, inputs, sheet, one);
    const graph::ImageId result = graph.image("packed layers", desc);
    graph.pass("pack layers", one ? m_packFirst : m_packTwo[packing.layerCount - 1])
        .read(inputs.viewBlock)
        .read(inputs.depth)
        .read(inputs.normals)
        .read(packing.thickness)
        .read(packing.second)
        .write(result)
        .constants(packing.constants)
        .dispatch(level0.x, level0.y);
    return result;
}

}  // namespace obscura::ao
