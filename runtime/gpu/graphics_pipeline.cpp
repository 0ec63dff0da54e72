#include "gpu/graphics_pipeline.h"

#include <iterator>

namespace obscura::gpu {

VkResult createGraphicsPipeline(const Device& device, const std::vector<VkPipelineShaderStageCreateInfo>& stages,
    const GraphicsState& state, VkPipelineLayout layout, VkPipeline& pipeline) {
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = uint32_t(state.colorFormats.size());
    rendering.pColorAttachmentFormats = state.colorFormats.data();
    rendering.depthAttachmentFormat = state.depthFormat;

    VkPipelineVertexInputStateCreateInfo vertices{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    vertices.vertexBindingDescriptionCount = uint32_t(state.vertexBindings.size());
    vertices.pVertexBindingDescriptions = state.vertexBindings.data();
    vertices.vertexAttributeDescriptionCount = uint32_t(state.vertexAttributes.size());
    vertices.pVertexAttributeDescriptions = state.vertexAttributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = state.topology;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.lineWidth = 1.0f;
    raster.depthBiasEnable = state.depthBias != 0.0f || state.depthBiasSlope != 0.0f;
    raster.depthBiasConstantFactor = state.depthBias;
    raster.depthBiasSlopeFactor = state.depthBiasSlope;
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = state.depthTest || state.depthWrite;  // without the test Vulkan writes no depth
    depth.depthWriteEnable = state.depthWrite;
    depth.depthCompareOp = state.depthTest ? state.depthCompare : VK_COMPARE_OP_ALWAYS;
    VkPipelineColorBlendAttachmentState over{};
    over.blendEnable = state.blend;
    over.srcColorBlendFactor = over.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    over.dstColorBlendFactor = over.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    over.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    const std::vector<VkPipelineColorBlendAttachmentState> targets(state.colorFormats.size(), over);
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = uint32_t(targets.size());
    blend.pAttachments = targets.data();
    constexpr VkDynamicState kDynamic[] = {
        VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR, VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_FRONT_FACE};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = uint32_t(std::size(kDynamic));
    dynamic.pDynamicStates = kDynamic;

    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    info.pNext = &rendering;
    info.stageCount = uint32_t(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &vertices;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.flags = device.caps().statistics ? kCaptureFlags : 0;
    info.layout = layout;
    return device.vk().CreateGraphicsPipelines(device.handle(), device.pipelineCache(), 1, &info, device.allocator(), &pipeline);
}

}  // namespace obscura::gpu
