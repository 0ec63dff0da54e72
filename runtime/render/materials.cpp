#include "render/materials.h"

#include <algorithm>

#include "scene/material.h"

namespace obscura::render {
namespace {

using gpu::Status;

constexpr uint32_t kTextures = 5;

VkSamplerAddressMode addressOf(scene::Wrap wrap) {
    switch (wrap) {
        case scene::Wrap::mirror: return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
        case scene::Wrap::clamp: return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        case scene::Wrap::repeat: break;
    }
    return VK_SAMPLER_ADDRESS_MODE_REPEAT;
}

std::vector<gpu::Binding> materialBindings(const gpu::Program& program) {
    std::vector<gpu::Binding> out;
    for (const gpu::Binding& binding : program.bindings())
        if (binding.set == 1) out.push_back(binding);
    return out;
}

bool same(const std::vector<gpu::Binding>& a, const std::vector<gpu::Binding>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
        [](const gpu::Binding& x, const gpu::Binding& y) { return x.binding == y.binding && x.kind == y.kind; });
}

}  // namespace

Status Materials::create(gpu::Device& device, Materials& out) {
    out.m_device = &device;
    const gpu::ImageDesc desc{VK_FORMAT_R8G8B8A8_UNORM, 1, 1, 1, 1, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    const Status status = gpu::Image::create(device, desc, "white", out.m_white);
    const uint32_t white = ~0u;
    return status == Status::ok
               ? gpu::upload(device, out.m_white, std::as_bytes(std::span(&white, 1)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)
               : status;
}

Materials::~Materials() {
    for (auto& [key, sets] : m_sets) m_device->release(VK_OBJECT_TYPE_DESCRIPTOR_POOL, sets.pool);
}

void Materials::forget(const ModelGpu& model) {
    for (auto it = m_sets.begin(); it != m_sets.end();) {
        if (it->first.first != &model) {
            ++it;
            continue;
        }
        m_device->release(VK_OBJECT_TYPE_DESCRIPTOR_POOL, it->second.pool);
        it = m_sets.erase(it);
    }
}

VkSampler Materials::samplerOf(const scene::Sampler& sampler) {
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = sampler.linearMag ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
    info.minFilter = sampler.linearMin ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
    info.addressModeU = addressOf(sampler.wrapU);
    info.addressModeV = addressOf(sampler.wrapV);
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    info.maxLod = sampler.mipmaps ? VK_LOD_CLAMP_NONE : 0.0f;
    const gpu::Caps& caps = m_device->caps();
    // A software rasterizer pays for every tap: one mip level, no anisotropy.
    info.mipmapMode = sampler.linearMin && !caps.software ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    info.anisotropyEnable = sampler.mipmaps && sampler.linearMin && caps.maxAnisotropy > 1.0f && !caps.software;
    info.maxAnisotropy = std::min(caps.maxAnisotropy, 8.0f);
    return m_device->sampler(info);
}

VkDescriptorSet Materials::get(const ModelGpu& model, uint32_t material, const gpu::Program& program) {
    Sets& sets = m_sets[{&model, &program}];
    const std::vector<gpu::Binding> bindings = materialBindings(program);
    if (sets.pool == VK_NULL_HANDLE || !same(bindings, sets.bindings)) {
        m_device->release(VK_OBJECT_TYPE_DESCRIPTOR_POOL, sets.pool);
        sets = {};
        sets.bindings = bindings;
        const uint32_t count = uint32_t(model.model->materials.size());
        sets.sets.assign(count, VK_NULL_HANDLE);
        const VkDescriptorPoolSize sizes[] = {
            {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, count}, {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count * kTextures}};
        VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
        info.maxSets = count;
        info.poolSizeCount = 2;
        info.pPoolSizes = sizes;
        m_device->vk().CreateDescriptorPool(m_device->handle(), &info, m_device->allocator(), &sets.pool);
    }
    VkDescriptorSet& set = sets.sets[material];
    if (set == VK_NULL_HANDLE) set = make(model, material, program, sets);
    return set;
}

VkDescriptorSet Materials::make(const ModelGpu& model, uint32_t material, const gpu::Program& program, Sets& sets) {
    const VkDescriptorSetLayout layout = program.setLayout(1);
    const VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, sets.pool, 1, &layout};
    VkDescriptorSet set = VK_NULL_HANDLE;
    if (sets.pool == VK_NULL_HANDLE || m_device->vk().AllocateDescriptorSets(m_device->handle(), &allocate, &set) != VK_SUCCESS) {
        m_device->log(gpu::Severity::error, "render: cannot allocate the descriptor set of a material of " + model.model->name);
        return VK_NULL_HANDLE;
    }
    const scene::Material& source = model.model->materials[material];
    const scene::TextureUse* uses[kTextures] = {&source.baseColorTexture, &source.metallicRoughnessTexture, &source.normalTexture,
        &source.emissionTexture, &source.occlusionTexture};
    const VkDescriptorBufferInfo block{model.materials.handle(), material * ModelGpu::kMaterialStride, sizeof(shared::MaterialBlock)};
    VkDescriptorImageInfo images[kTextures];
    for (uint32_t slot = 0; slot < kTextures; ++slot) {
        const scene::Texture texture = uses[slot]->texture >= 0 ? model.model->textures[size_t(uses[slot]->texture)] : scene::Texture{};
        const VkImageView view = texture.image >= 0 ? model.images[size_t(texture.image)].view() : m_white.view();
        images[slot] = {samplerOf(texture.sampler), view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    }
    std::vector<VkWriteDescriptorSet> writes;
    for (const gpu::Binding& binding : sets.bindings) {
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, set, binding.binding, 0, 1};
        if (binding.kind == gpu::BindingKind::uniformBuffer) {
            write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
            write.pBufferInfo = &block;
        } else {
            write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
            write.pImageInfo = &images[binding.binding - 1];
        }
        writes.push_back(write);
    }
    m_device->vk().UpdateDescriptorSets(m_device->handle(), uint32_t(writes.size()), writes.data(), 0, nullptr);
    return set;
}

uint32_t mapsOf(const scene::Material& m) {
    const scene::TextureUse* uses[kTextures] = {
        &m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.emissionTexture, &m.occlusionTexture};
    uint32_t bits = 0;
    for (uint32_t slot = 0; slot < kTextures; ++slot)
        if (uses[slot]->texture >= 0) bits |= 1u << slot;
    return bits;
}

Status MaterialProgram::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, std::string vertex, std::string fragment,
    gpu::GraphicsState state, MaterialProgram& out) {
    out.m_device = &device;
    out.m_shaders = &shaders;
    out.m_vertex = std::move(vertex);
    out.m_fragment = std::move(fragment);
    out.m_state = std::move(state);
    return gpu::Program::graphics(device, shaders, out.m_vertex, out.m_fragment, out.m_state, {{0, 0}, {1, 0}}, out.m_base);
}

gpu::Program* MaterialProgram::variant(const scene::Material& material) {
    const uint32_t masked = material.alphaMode == scene::AlphaMode::mask ? 1 : 0, maps = mapsOf(material);
    const uint32_t key = maps << 1 | masked;
    if (key == 0) return &m_base;
    const auto [at, fresh] = m_variants.try_emplace(key);
    if (fresh) gpu::Program::graphics(*m_device, *m_shaders, m_vertex, m_fragment, m_state, {{0, masked}, {1, maps}}, at->second);
    return at->second ? &at->second : nullptr;
}

Status MaterialProgram::prepare(const scene::Material& material) { return variant(material) ? Status::ok : Status::shaderError; }

void MaterialProgram::bind(VkCommandBuffer cmd, const ModelGpu& model, uint32_t material, Materials& materials, VkPipeline& bound) {
    gpu::Program* program = variant(model.model->materials[material]);
    if (!program) program = &m_base;
    program->refresh();
    const gpu::Api& vk = m_device->vk();
    if (program->pipeline() != bound) vk.CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, bound = program->pipeline());
    const VkDescriptorSet set = materials.get(model, material, m_base);
    if (set != VK_NULL_HANDLE) vk.CmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, program->layout(), 1, 1, &set, 0, nullptr);
}

}  // namespace obscura::render
