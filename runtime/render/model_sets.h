// Descriptor sets of storage buffers, one a model, for compute passes that read what a model keeps on the GPU.
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

    // The model's set, made when first asked for; bindings from 0 on are the buffers, whole. Null when there is no memory for it.
    VkDescriptorSet of(gpu::Device& device, VkDescriptorSetLayout layout, const ModelGpu& model, std::initializer_list<const gpu::Buffer*> buffers);
    void forget(const ModelGpu& model);

private:
    struct Entry { VkDescriptorPool pool = VK_NULL_HANDLE; VkDescriptorSet set = VK_NULL_HANDLE; };
    gpu::Device* m_device = nullptr;
    std::map<const ModelGpu*, Entry> m_entries;
};

}  // namespace obscura::render
