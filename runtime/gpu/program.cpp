#include "gpu/program.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <fmt/format.h>

#include "gpu/graphics_pipeline.h"
#include "gpu/result.h"

namespace obscura::gpu {

namespace {

// The minimum that every Vulkan device supports.
constexpr uint32_t kMaxPushConstantBytes = 128;

struct Specialization {
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<uint32_t> values;
    VkSpecializationInfo info{};

    explicit Specialization(const std::vector<Constant>& constants) {
        for (const Constant& constant : constants) {
            entries.push_back({constant.id, uint32_t(values.size() * sizeof(uint32_t)), sizeof(uint32_t)});
            values.push_back(constant.value);
        }
        info = {uint32_t(entries.size()), entries.data(), values.size() * sizeof(uint32_t), values.data()};
    }
};

}  // namespace

VkDescriptorType descriptorType(BindingKind kind) {
    switch (kind) {
        case BindingKind::sampledImage: return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        case BindingKind::storageImage: return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        case BindingKind::uniformBuffer: return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        case BindingKind::storageBuffer: return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    }
    return VK_DESCRIPTOR_TYPE_MAX_ENUM;
}

VkPipelineStageFlags2 pipelineStages(VkShaderStageFlags stages) {
    VkPipelineStageFlags2 result = 0;
    if (stages & VK_SHADER_STAGE_COMPUTE_BIT) result |= VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    if (stages & VK_SHADER_STAGE_VERTEX_BIT) result |= VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT;
    if (stages & VK_SHADER_STAGE_FRAGMENT_BIT) result |= VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    return result;
}

void beginRendering(const Device& device, VkCommandBuffer cmd, VkExtent2D extent, std::span<const VkRenderingAttachmentInfo> colors,
    const VkRenderingAttachmentInfo* depth) {
    const Api& vk = device.vk();
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea.extent = extent;
    info.layerCount = 1;
    info.colorAttachmentCount = uint32_t(colors.size());
    info.pColorAttachments = colors.data();
    info.pDepthAttachment = depth;
    vk.CmdBeginRendering(cmd, &info);
    const VkViewport viewport{0, 0, float(extent.width), float(extent.height), 0, 1};
    vk.CmdSetViewport(cmd, 0, 1, &viewport);
    vk.CmdSetScissor(cmd, 0, 1, &info.renderArea);
    vk.CmdSetCullMode(cmd, VK_CULL_MODE_NONE);
    vk.CmdSetFrontFace(cmd, VK_FRONT_FACE_COUNTER_CLOCKWISE);
}

Program::~Program() { releaseAll(); }

void Program::releaseAll() {
    if (!m_device) return;
    m_device->release(VK_OBJECT_TYPE_PIPELINE, m_pipeline);
    m_device->release(VK_OBJECT_TYPE_PIPELINE_LAYOUT, m_layout);
    for (VkDescriptorSetLayout layout : m_setLayouts) m_device->release(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, layout);
    m_pipeline = VK_NULL_HANDLE;
    m_layout = VK_NULL_HANDLE;
    m_setLayouts.clear();
}

void Program::swap(Program& other) noexcept {
    std::swap(m_device, other.m_device);
    std::swap(m_shaders, other.m_shaders);
    std::swap(m_name, other.m_name);
    std::swap(m_vertex, other.m_vertex);
    std::swap(m_fragment, other.m_fragment);
    std::swap(m_constants, other.m_constants);
    std::swap(m_state, other.m_state);
    std::swap(m_bindPoint, other.m_bindPoint);
    std::swap(m_generation, other.m_generation);
    std::swap(m_pipeline, other.m_pipeline);
    std::swap(m_layout, other.m_layout);
    std::swap(m_setLayouts, other.m_setLayouts);
    std::swap(m_bindings, other.m_bindings);
    std::swap(m_bindingStages, other.m_bindingStages);
    std::swap(m_stages, other.m_stages);
    std::swap(m_workgroup, other.m_workgroup);
    std::swap(m_pushConstantBytes, other.m_pushConstantBytes);
}

Status Program::compute(
    Device& device, const ShaderLibrary& shaders, std::string_view name, std::vector<Constant> constants, Program& out) {
    out = Program();
    Program made;
    made.m_device = &device;
    made.m_shaders = &shaders;
    made.m_name = made.m_vertex = name;
    made.m_constants = std::move(constants);
    made.m_bindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
    if (Status status = made.build(); status != Status::ok) return status;
    out = std::move(made);
    return Status::ok;
}

Status Program::graphics(Device& device, const ShaderLibrary& shaders, std::string_view vertex, std::string_view fragment,
    const GraphicsState& state, std::vector<Constant> constants, Program& out) {
    out = Program();
    Program made;
    made.m_device = &device;
    made.m_shaders = &shaders;
    made.m_vertex = vertex;
    made.m_fragment = fragment;
    made.m_name = fragment.empty() ? made.m_vertex : fmt::format("{} + {}", vertex, fragment);
    made.m_constants = std::move(constants);
    made.m_state = state;
    made.m_bindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    if (Status status = made.build(); status != Status::ok) return status;
    out = std::move(made);
    return Status::ok;
}

void Program::refresh() {
    if (!m_shaders) return;
    const uint64_t generation = m_shaders->generation(m_vertex) + m_shaders->generation(m_fragment);
    if (generation == m_generation) return;
    m_generation = generation;  // on failure too: one attempt an edit
    Program next;
    next.m_device = m_device;
    next.m_shaders = m_shaders;
    next.m_name = m_name;
    next.m_vertex = m_vertex;
    next.m_fragment = m_fragment;
    next.m_constants = m_constants;
    next.m_state = m_state;
    next.m_bindPoint = m_bindPoint;
    if (next.build() == Status::ok) swap(next);
}

VkShaderStageFlags Program::stagesOf(const Binding& binding) const {
    for (size_t i = 0; i < m_bindings.size(); ++i)
        if (m_bindings[i].set == binding.set && m_bindings[i].binding == binding.binding) return m_bindingStages[i];
    return 0;
}

std::span<const Binding> Program::bindings(uint32_t set) const {
    const auto [first, last] = std::equal_range(
        m_bindings.begin(), m_bindings.end(), Binding{.set = set}, [](const Binding& a, const Binding& b) { return a.set < b.set; });
    return {first, last};
}

void Program::bind(VkCommandBuffer cmd, VkDescriptorSet set) const {
    m_device->vk().CmdBindPipeline(cmd, m_bindPoint, m_pipeline);
    if (set) m_device->vk().CmdBindDescriptorSets(cmd, m_bindPoint, m_layout, 0, 1, &set, 0, nullptr);
}

void Program::push(VkCommandBuffer cmd, const void* data, uint32_t bytes, uint32_t offset) const {
    assert(offset + bytes <= m_pushConstantBytes);
    m_device->vk().CmdPushConstants(cmd, m_layout, m_stages, offset, bytes, data);
}

// On failure the half-made handles go with the object.
Status Program::build() {
    const auto bad = [&](Status status, const std::string& why) {
        return fail(*m_device, status, fmt::format("program '{}': {}", m_name, why));
    };
    const bool isCompute = m_bindPoint == VK_PIPELINE_BIND_POINT_COMPUTE;
    std::vector<const Shader*> shaders;
    m_generation = 0;
    for (const std::string* name : {&m_vertex, &m_fragment}) {
        if (name->empty()) continue;
        const Shader* shader = m_shaders->find(*name);
        if (!shader || shader->spirv.empty()) return bad(Status::shaderError, fmt::format("there is no shader '{}'", *name));
        const VkShaderStageFlagBits stage = isCompute           ? VK_SHADER_STAGE_COMPUTE_BIT
                                            : name == &m_vertex ? VK_SHADER_STAGE_VERTEX_BIT
                                                                : VK_SHADER_STAGE_FRAGMENT_BIT;
        if (shader->stage != stage) return bad(Status::invalid, fmt::format("'{}' is a shader of another stage", *name));
        shaders.push_back(shader);
        m_generation += m_shaders->generation(*name);
    }
    if (shaders.empty()) return bad(Status::invalid, "it has no shader");

    struct Merged {
        Binding binding;
        VkShaderStageFlags stages;
    };
    std::vector<Merged> merged;
    for (const Shader* shader : shaders) {
        m_stages |= shader->stage;
        m_pushConstantBytes = std::max(m_pushConstantBytes, shader->pushConstantBytes);
        for (const Binding& binding : shader->bindings) {
            const auto same = std::find_if(merged.begin(), merged.end(),
                [&](const Merged& m) { return m.binding.set == binding.set && m.binding.binding == binding.binding; });
            if (same == merged.end()) {
                merged.push_back({binding, VkShaderStageFlags(shader->stage)});
                continue;
            }
            if (same->binding.kind != binding.kind)
                return bad(Status::invalid, fmt::format("its stages disagree on what set {} binding {} is ('{}', '{}')", binding.set,
                                                binding.binding, same->binding.name, binding.name));
            same->binding.reads |= binding.reads;
            same->binding.writes |= binding.writes;
            same->stages |= shader->stage;
        }
    }
    std::sort(merged.begin(), merged.end(), [](const Merged& a, const Merged& b) {
        return std::pair(a.binding.set, a.binding.binding) < std::pair(b.binding.set, b.binding.binding);
    });
    if (m_pushConstantBytes > kMaxPushConstantBytes)
        return bad(
            Status::unsupported, fmt::format("{} bytes of push constants; {} are allowed", m_pushConstantBytes, kMaxPushConstantBytes));
    m_workgroup = isCompute ? shaders.front()->workgroup : std::array<uint32_t, 3>{1, 1, 1};
    for (const Merged& m : merged) {
        m_bindings.push_back(m.binding);
        m_bindingStages.push_back(m.stages);
    }

    const Api& vk = m_device->vk();
    const uint32_t sets = merged.empty() ? 0 : merged.back().binding.set + 1;
    for (uint32_t set = 0; set < sets; ++set) {
        std::vector<VkDescriptorSetLayoutBinding> slots;
        for (const Merged& m : merged)
            if (m.binding.set == set) slots.push_back({m.binding.binding, descriptorType(m.binding.kind), 1, m.stages, nullptr});
        VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
        info.bindingCount = uint32_t(slots.size());
        info.pBindings = slots.data();
        VkDescriptorSetLayout layout = VK_NULL_HANDLE;
        if (VkResult result = vk.CreateDescriptorSetLayout(m_device->handle(), &info, m_device->allocator(), &layout))
            return bad(fromVulkan(result), resultName(result));
        m_setLayouts.push_back(layout);
    }
    // One range over all stages, so that stages() is what vkCmdPushConstants is called with.
    const VkPushConstantRange range{m_stages, 0, (m_pushConstantBytes + 3) & ~3u};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = sets;
    info.pSetLayouts = m_setLayouts.data();
    info.pushConstantRangeCount = range.size ? 1 : 0;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkResult result = vk.CreatePipelineLayout(m_device->handle(), &info, m_device->allocator(), &layout);
    if (result != VK_SUCCESS) return bad(fromVulkan(result), resultName(result));
    m_layout = layout;

    const Specialization specialization(m_constants);
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    for (const Shader* shader : shaders) {
        VkShaderModuleCreateInfo module{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
        module.codeSize = shader->spirv.size() * sizeof(uint32_t);
        module.pCode = shader->spirv.data();
        VkPipelineShaderStageCreateInfo stage{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
        result = vk.CreateShaderModule(m_device->handle(), &module, m_device->allocator(), &stage.module);
        if (result != VK_SUCCESS) break;
        stage.stage = shader->stage;
        stage.pName = "main";
        stage.pSpecializationInfo = &specialization.info;
        stages.push_back(stage);
    }
    VkPipeline pipeline = VK_NULL_HANDLE;
    if (result == VK_SUCCESS) {
        if (isCompute) {
            VkComputePipelineCreateInfo create{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
            create.stage = stages.front();
            create.layout = m_layout;
            create.flags = m_device->caps().statistics ? kCaptureFlags : 0;
            result = vk.CreateComputePipelines(m_device->handle(), m_device->pipelineCache(), 1, &create, m_device->allocator(), &pipeline);
        } else {
            result = createGraphicsPipeline(*m_device, stages, m_state, m_layout, pipeline);
        }
    }
    for (const VkPipelineShaderStageCreateInfo& stage : stages)
        vk.DestroyShaderModule(m_device->handle(), stage.module, m_device->allocator());
    if (result != VK_SUCCESS) {  // an answer that means nothing else is about the shader
        const Status status = fromVulkan(result);
        return bad(status == Status::invalid ? Status::shaderError : status,
            fmt::format("the driver refused the pipeline: {}", resultName(result)));
    }
    m_pipeline = pipeline;
    m_device->nameObject(VK_OBJECT_TYPE_PIPELINE, (uint64_t)m_pipeline, m_name.c_str());
    return Status::ok;
}

}  // namespace obscura::gpu
