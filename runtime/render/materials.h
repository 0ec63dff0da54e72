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

    // The set for the program's layout of set 1, created at first use, and again if a hot reload changed the bindings. Null, with a log
    // line, if it cannot be allocated.
    VkDescriptorSet get(const ModelGpu& model, uint32_t material, const gpu::Program& program);
    void forget(const ModelGpu& model);  // call it before the model is destroyed

private:
    struct Sets {
        VkDescriptorPool pool = VK_NULL_HANDLE;
        std::vector<gpu::Binding> bindings;  // of the sets' layout
        std::vector<VkDescriptorSet> sets;   // one per material, null until used
    };
    VkDescriptorSet make(const ModelGpu& model, uint32_t material, const gpu::Program& program, Sets& sets);
    VkSampler samplerOf(const scene::Sampler& sampler);

    gpu::Device* m_device = nullptr;
    gpu::Image m_white;
    std::map<std::pair<const ModelGpu*, const gpu::Program*>, Sets> m_sets;
};

// Which of the five texture slots a material fills, as bits.
uint32_t mapsOf(const scene::Material& material);

// A vertex and a fragment shader, with a pipeline for each kind of material: specialization constants 0 (alpha-masked) and 1 (texture
// slots). All pipelines share their layouts.
class MaterialProgram {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, std::string vertex, std::string fragment,
        gpu::GraphicsState state, MaterialProgram& out);
    // Creates the pipeline of a material ahead of its first draw.
    gpu::Status prepare(const scene::Material& material);

    gpu::Program& base() { return m_base; }  // for the graph: layouts and set 0
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
