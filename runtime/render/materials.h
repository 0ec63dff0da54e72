// Descriptor set 1: a material's uniform block and textures, for each program that reads materials.
#pragma once

#include <map>

#include "gpu/program.h"
#include "render/model_gpu.h"

namespace obscura::render {

class Materials {
public:
    static gpu::Status create(gpu::Device& device, Materials& out);
    ~Materials();
    Materials() = default;
    Materials(const Materials&) = delete;
    Materials& operator=(const Materials&) = delete;

    // Null, once logged, when the pool is exhausted. The set fits the program's layout of set 1 and is made when first
    // asked for; a program whose bindings a hot reload changed gets new ones.
    VkDescriptorSet get(const ModelGpu& model, uint32_t material, const gpu::Program& program);
    void forget(const ModelGpu& model);  // before the model goes

private:
    struct Sets {
        VkDescriptorPool pool = VK_NULL_HANDLE;
        std::vector<gpu::Binding> bindings;  // of the layout they were made for
        std::vector<VkDescriptorSet> sets;   // one a material, null until asked for
    };
    VkDescriptorSet make(const ModelGpu& model, uint32_t material, const gpu::Program& program, Sets& sets);
    VkSampler samplerOf(const scene::Sampler& sampler);

    gpu::Device* m_device = nullptr;
    gpu::Image m_white;
    std::map<std::pair<const ModelGpu*, const gpu::Program*>, Sets> m_sets;
};

}  // namespace obscura::render
