#include "gpu/descriptor_pool.h"

#include <iterator>

namespace obscura::gpu {
namespace {

constexpr uint32_t kSetsPerPool = 64;

}  // namespace

DescriptorPool::~DescriptorPool() {
    for (VkDescriptorPool pool : m_pools) m_device.release(VK_OBJECT_TYPE_DESCRIPTOR_POOL, pool);
}

void DescriptorPool::reset() {
    m_current = 0;
    for (VkDescriptorPool pool : m_pools) m_device.vk().ResetDescriptorPool(m_device.handle(), pool, 0);
}

VkDescriptorSet DescriptorPool::make(const Program& program, uint32_t set, std::span<const Descriptor> contents) {
    const VkDescriptorSet made = allocate(program.setLayout(set));
    if (!made) return VK_NULL_HANDLE;
    std::vector<VkWriteDescriptorSet> writes;
    for (const Binding& binding : program.bindings(set)) {
        const Descriptor& content = contents[writes.size()];
        writes.push_back({VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, made, binding.binding, 0, 1, descriptorType(binding.kind),
            &content.image, &content.buffer});
    }
    m_device.vk().UpdateDescriptorSets(m_device.handle(), uint32_t(writes.size()), writes.data(), 0, nullptr);
    return made;
}

bool DescriptorPool::reserve(uint32_t sets) {
    while (m_pools.size() * kSetsPerPool < sets)
        if (!grow()) return false;
    return true;
}

VkDescriptorSet DescriptorPool::allocate(VkDescriptorSetLayout layout) {
    for (;; ++m_current) {
        const bool fresh = m_current == m_pools.size();
        if (fresh && !grow()) return VK_NULL_HANDLE;
        const VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, m_pools[m_current], 1, &layout};
        VkDescriptorSet set = VK_NULL_HANDLE;
        if (m_device.vk().AllocateDescriptorSets(m_device.handle(), &info, &set) == VK_SUCCESS) return set;
        if (fresh) return VK_NULL_HANDLE;
    }
}

bool DescriptorPool::grow() {
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kSetsPerPool * 6},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kSetsPerPool * 6}, {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kSetsPerPool * 3},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kSetsPerPool * 8}};
    VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.maxSets = kSetsPerPool;
    info.poolSizeCount = uint32_t(std::size(sizes));
    info.pPoolSizes = sizes;
    m_pools.reserve(m_pools.size() + 1);  // so that nothing is lost when host memory runs out
    VkDescriptorPool pool = VK_NULL_HANDLE;
    if (m_device.vk().CreateDescriptorPool(m_device.handle(), &info, m_device.allocator(), &pool) != VK_SUCCESS) return false;
    m_pools.push_back(pool);
    return true;
}

}  // namespace obscura::gpu
