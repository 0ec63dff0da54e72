// A format as Vulkan spells it, for messages.
#pragma once

#include <string>

#include <vulkan/vulkan_core.h>

namespace obscura::gpu {

std::string formatName(VkFormat format);  // "VK_FORMAT_R8G8B8A8_UNORM"; "VkFormat 1000156000" outside Vulkan 1.0

}  // namespace obscura::gpu
