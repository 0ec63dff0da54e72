// A pipeline with the layouts its shaders declare. Set 0 is filled by the render graph, in the order of a pass's reads
// and writes; higher sets belong to the caller (materials). Rebuilt by itself after a hot reload; a shader that no longer
// compiles keeps the last good pipeline.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/shader.h"

namespace obscura::gpu {

struct Constant {  // specialization constant
    uint32_t id;
    uint32_t value;  // bit pattern: use std::bit_cast for floats
};

struct GraphicsState {
    std::vector<VkFormat> colorFormats;
    VkFormat depthFormat = VK_FORMAT_UNDEFINED;
    bool depthTest = false, depthWrite = false;
    VkCompareOp depthCompare = VK_COMPARE_OP_GREATER_OR_EQUAL;  // reversed depth
    float depthBias = 0.0f, depthBiasSlope = 0.0f;
    bool blend = false;  // premultiplied "over" on every colour target
    std::vector<VkVertexInputBindingDescription> vertexBindings;
    std::vector<VkVertexInputAttributeDescription> vertexAttributes;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
};  // viewport, scissor, cull mode and front face are dynamic

VkDescriptorType descriptorType(BindingKind kind);
VkPipelineStageFlags2 pipelineStages(VkShaderStageFlags stages);  // that run these shaders

// Begins rendering to all of the attachments, `depth` or null, and sets the dynamic state: a viewport and a scissor of that extent, no
// culling, counter-clockwise front faces.
void beginRendering(const Device& device, VkCommandBuffer cmd, VkExtent2D extent, std::span<const VkRenderingAttachmentInfo> colors,
    const VkRenderingAttachmentInfo* depth);

class Program {
public:
    Program() = default;
    Program(Program&& other) noexcept { swap(other); }
    Program& operator=(Program&& other) noexcept {
        Program gone(std::move(other));
        swap(gone);
        return *this;
    }
    ~Program();

    static Status compute(
        Device& device, const ShaderLibrary& shaders, std::string_view name, std::vector<Constant> constants, Program& out);
    static Status graphics(Device& device, const ShaderLibrary& shaders, std::string_view vertex, std::string_view fragment,
        const GraphicsState& state, std::vector<Constant> constants, Program& out);

    explicit operator bool() const { return m_pipeline != VK_NULL_HANDLE; }
    // Rebuilds after a hot reload when needed (old handles are released, deferred). Cheap otherwise.
    void refresh();

    VkPipeline pipeline() const { return m_pipeline; }
    VkPipelineLayout layout() const { return m_layout; }
    VkPipelineBindPoint bindPoint() const { return m_bindPoint; }
    VkDescriptorSetLayout setLayout(uint32_t set) const { return set < m_setLayouts.size() ? m_setLayouts[set] : VK_NULL_HANDLE; }
    VkShaderStageFlags stages() const { return m_stages; }
    // Merged over stages, sorted by set and binding: of all sets, of one.
    const std::vector<Binding>& bindings() const { return m_bindings; }
    std::span<const Binding> bindings(uint32_t set) const;
    VkShaderStageFlags stagesOf(const Binding& binding) const;
    const std::array<uint32_t, 3>& workgroup() const { return m_workgroup; }
    uint32_t pushConstantBytes() const { return m_pushConstantBytes; }
    const std::string& name() const { return m_name; }
    const std::string& shader() const { return m_vertex; }  // name of the compute or vertex shader
    const std::vector<Constant>& specialization() const { return m_constants; }

    void bind(VkCommandBuffer cmd, VkDescriptorSet set) const;                                // the pipeline and set 0, if not null
    void push(VkCommandBuffer cmd, const void* data, uint32_t bytes, uint32_t offset) const;  // constants

private:
    void swap(Program& other) noexcept;
    Status build();
    void releaseAll();
    Device* m_device = nullptr;
    const ShaderLibrary* m_shaders = nullptr;
    std::string m_name, m_vertex, m_fragment;  // compute: m_vertex is the only shader
    std::vector<Constant> m_constants;
    GraphicsState m_state;
    VkPipelineBindPoint m_bindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
    uint64_t m_generation = 0;
    VkPipeline m_pipeline = VK_NULL_HANDLE;
    VkPipelineLayout m_layout = VK_NULL_HANDLE;
    std::vector<VkDescriptorSetLayout> m_setLayouts;
    std::vector<Binding> m_bindings;
    std::vector<VkShaderStageFlags> m_bindingStages;
    VkShaderStageFlags m_stages = 0;
    std::array<uint32_t, 3> m_workgroup{1, 1, 1};
    uint32_t m_pushConstantBytes = 0;
};

}  // namespace obscura::gpu
