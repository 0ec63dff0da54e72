// Creation of a graphics pipeline with dynamic rendering, for program.cpp.
#pragma once

#include "gpu/program.h"

namespace obscura::gpu {

// With DeviceOptions::statistics, of every pipeline: for pipeline_statistics.h.
inline constexpr VkPipelineCreateFlags kCaptureFlags =
    VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR | VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR;

VkResult createGraphicsPipeline(const Device& device, const std::vector<VkPipelineShaderStageCreateInfo>& stages,
    const GraphicsState& state, VkPipelineLayout layout, VkPipeline& pipeline);

}  // namespace obscura::gpu
