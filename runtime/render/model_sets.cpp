#include "render/model_sets.h"

namespace obscura::render {

ModelSets::~ModelSets() {
    for (auto& [model, entry] : m_entries) m_device->release(VK_OBJECT_TYPE_DESCRIPTOR_POOL, entry.pool);
}

void ModelSets::forget(const ModelGpu& model) {
    const auto found = m_entries.find(&model);
    if (found == m_entries.end()) return;
    m_device->release(VK_OBJECT_TYPE_DESCRIPTOR_POOL, found->second.pool);
    m_entries.erase(found);
}

VkDescriptorSet ModelSets::of(
    gpu::Device& device, VkDescriptorSetLayout layout, const ModelGpu& model, std::initializer_list<const gpu::Buffer*> buffers) {
    m_device = &device;
    Entry& entry = m_entries[&model];
    if (entry.set != VK_NULL_HANDLE) return entry.set;
    const gpu::Api& vk = device.vk();
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, uint32_t(buffers.size())};
    VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.maxSets = 1;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    if (entry.pool == VK_NULL_HANDLE && vk.CreateDescriptorPool(device.handle(), &info, device.allocator(), &entry.pool) != VK_SUCCESS)
        return VK_NULL_HANDLE;
    const VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, entry.pool, 1, &layout};
    if (vk.AllocateDescriptorSets(device.handle(), &allocate, &entry.set) != VK_SUCCESS) {
        entry.set = VK_NULL_HANDLE;
        return VK_NULL_HANDLE;
    }
    std::vector<VkDescriptorBufferInfo> infos;
    for (const gpu::Buffer* buffer : buffers) infos.push_back({buffer->handle(), 0, VK_WHOLE_SIZE});
    VkWriteDescriptorSet write{
        VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, entry.set, 0, 0, uint32_t(infos.size()), VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    write.pBufferInfo = infos.data();
    vk.UpdateDescriptorSets(device.handle(), 1, &write, 0, nullptr);
    return entry.set;
}

}  // namespace obscura::render
