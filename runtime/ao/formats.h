// Formats that a frame's images may have, by role.
#pragma once

#include <vulkan/vulkan_core.h>
#include <cstdint>

namespace obscura::ao {

enum class Role : uint8_t { deviceDepth, linearDepth, signedNormals, unsignedNormals, packedNormals, motion, thickness, second };

bool fits(Role role, VkFormat format);
const char* formatsOf(Role role);      // "D16, D24, D32 or R32F"
uint32_t leastBytes(VkFormat format);  // bytes of a texel, at least; 0 for formats that fit no role

}  // namespace obscura::ao
