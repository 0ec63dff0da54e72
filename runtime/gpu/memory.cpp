// Where images and buffers get their memory: from the device, one allocation each, or from the host's pools.
#include <fmt/format.h>

#include "gpu/result.h"

namespace obscura::gpu {

void Device::releaseMemory(const MemoryBlock& block) {
    if (block.memory) m_released.push_back({m_frame, VK_OBJECT_TYPE_DEVICE_MEMORY, (uint64_t)block.memory, block});
}

Status Device::allocate(
    const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred, bool image, MemoryBlock& block) {
    // Other kinds (lazily allocated, protected, vendors' coherent ones) need features that are not on.
    constexpr VkMemoryPropertyFlags kPlain = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                             VK_MEMORY_PROPERTY_HOST_COHERENT_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    VkResult result = VK_ERROR_FEATURE_NOT_PRESENT;
    for (VkMemoryPropertyFlags demand : {wanted | preferred, wanted}) {
        VkMemoryRequirements fitting = needs;
        for (uint32_t type = 0; type < VK_MAX_MEMORY_TYPES; ++type) {
            const VkMemoryPropertyFlags flags = type < m_memory.memoryTypeCount ? m_memory.memoryTypes[type].propertyFlags : 0;
            if (flags == 0 || (flags & demand) != demand || (flags & ~kPlain)) fitting.memoryTypeBits &= ~(1u << type);
        }
        block = {};
        if (fitting.memoryTypeBits) result = allocateBlock(fitting, wanted & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT, image, block);
        if (fitting.memoryTypeBits && result == VK_SUCCESS) {
            m_memoryUse += block.bytes;
            return Status::ok;
        }
        if (preferred == 0) break;
    }
    block = {};
    return fromVulkan(result);
}

VkResult Device::allocateBlock(const VkMemoryRequirements& needs, bool mapped, bool image, MemoryBlock& block) {
    if (m_memorySource.allocate) {
        const VkResult result = m_memorySource.allocate(needs, mapped, image, block);
        block.bytes = needs.size;
        if (result != VK_SUCCESS) return result;
        if (block.memory && block.offset % needs.alignment == 0 && (block.mapped || !mapped)) return VK_SUCCESS;
        log(Severity::error,
            !block.memory ? "the host's memory callback gave no memory"
            : block.offset % needs.alignment
                ? fmt::format("the host's memory callback gave offset {}, not a multiple of {}", block.offset, needs.alignment)
                : "the host's memory callback gave memory without its address, which was asked for");
        if (block.memory && m_memorySource.free) m_memorySource.free(block);
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    VkResult result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    block.bytes = needs.size;
    for (uint32_t type = 0; type < m_memory.memoryTypeCount && result != VK_SUCCESS; ++type) {
        if (!(needs.memoryTypeBits >> type & 1)) continue;
        const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size, type};
        result = m_vk.AllocateMemory(m_device, &info, m_allocator, &block.memory);
    }
    if (result != VK_SUCCESS || !mapped) return result;
    void* address = nullptr;
    result = m_vk.MapMemory(m_device, block.memory, 0, VK_WHOLE_SIZE, 0, &address);
    block.mapped = static_cast<std::byte*>(address);
    if (result != VK_SUCCESS) m_vk.FreeMemory(m_device, block.memory, m_allocator);
    return result;
}

void Device::freeBlock(const MemoryBlock& block) {
    if (m_memorySource.free) m_memorySource.free(block);
    else m_vk.FreeMemory(m_device, block.memory, m_allocator);  // which unmaps
    m_memoryUse -= block.bytes;
}

}  // namespace obscura::gpu
