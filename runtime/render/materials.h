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

// Which of the five texture slots a material fills, as bits.
uint32_t mapsOf(const scene::Material& material);

// A pair of shaders in as many pipelines as the materials in use differ in kind: textures they have, holes. Specialization
// constants 0 (masked) and 1 (maps). All variants share their layouts.
class MaterialProgram {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, std::string vertex, std::string fragment,
                              gpu::GraphicsState state, MaterialProgram& out);
    // Makes the pipeline a material needs, so that drawing need not wait for it.
    gpu::Status prepare(const scene::Material& material);

    gpu::Program& base() { return m_base; }  // for the graph: the layouts, set 0
    // Binds pipeline and set 1 for a material. `bound` remembers the pipeline between calls within a pass.
    void bind(VkCommandBuffer cmd, const ModelGpu& model, uint32_t material, Materials& materials, VkPipeline& bound);

private:
    gpu::Program* variant(const scene::Material& material);
    gpu::Device* m_device = nullptr;
    const gpu::ShaderLibrary* m_shaders = nullptr;
    std::string m_vertex, m_fragment;
    gpu::GraphicsState m_state;
    gpu::Program m_base;
    std::map<uint32_t, gpu::Program> m_variants;  // by constants
};

}  // namespace obscura::render
