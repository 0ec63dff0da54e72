// Descriptor sets of storage buffers, one per model, for compute passes that read a model's buffers.
#pragma once

#include <initializer_list>
#include <map>

#include "render/model_gpu.h"

namespace obscura::render {

class ModelSets {
public:
    ModelSets() = default;
    ~ModelSets();
    ModelSets(const ModelSets&) = delete;

    // The model's set, created at first use; bindings 0, 1, ... are the buffers. Null if it cannot be allocated.
    VkDescriptorSet of(
        gpu::Device& device, VkDescriptorSetLayout layout, const ModelGpu& model, std::initializer_list<const gpu::Buffer*> buffers);
    void forget(const ModelGpu& model);

private:
    struct Entry {
        VkDescriptorPool pool = VK_NULL_HANDLE;
        VkDescriptorSet set = VK_NULL_HANDLE;
    };
    gpu::Device* m_device = nullptr;
    std::map<const ModelGpu*, Entry> m_entries;
};

}  // namespace obscura::render
