// Device memory as images and buffers see it: a piece of an allocation, ours or the host's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "gpu/api.h"

namespace obscura::gpu {

// Where an image or a buffer lies.
struct MemoryBlock {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    uint64_t offset = 0, bytes = 0;
    std::byte* mapped = nullptr;  // address of the first byte, where it was asked for
    void* token = nullptr;        // the source's own
};

// Device memory from a host's pools instead of vkAllocateMemory. Requirements name only memory types that will do.
struct MemorySource {
    std::function<VkResult(const VkMemoryRequirements&, bool mapped, bool image, MemoryBlock&)> allocate;
    std::function<void(const MemoryBlock&)> free;
};

}  // namespace obscura::gpu
