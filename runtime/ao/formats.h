// Which formats a frame's images may have, for each part that they play: what the passes that read them can make sense of.
#pragma once

#include <cstdint>
#include <vulkan/vulkan_core.h>

namespace obscura::ao {

enum class Role : uint8_t { deviceDepth, linearDepth, signedNormals, unsignedNormals, packedNormals, motion, thickness, second };

bool fits(Role role, VkFormat format);
const char* formatsOf(Role role);         // in words
uint32_t leastBytes(VkFormat format);     // that a texel takes at least, of formats that fit any role

}  // namespace obscura::ao
