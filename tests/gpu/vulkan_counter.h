// Counts recorded commands and created objects by hooks in a device's table of entry points. Tests compare work by these counts, not by
// times. Works on a device, or on a library that adopts the device and loads its entry points through instanceProc(). One counter at a
// time, one thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <map>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"

namespace obscura::test {

// A vkCmdDispatch and its state.
struct Dispatch {
    std::string pass;                      // enclosing debug label; empty without labels
    VkPipeline pipeline = VK_NULL_HANDLE;  // shader and specialization constants
    uint32_t loops = 0;                    // in the shader's SPIR-V; for pipelines created while a counter existed
    std::array<uint32_t, 3> groups{};      // workgroups
    std::vector<std::byte> constants;      // push constants
    uint64_t workgroups() const { return uint64_t(groups[0]) * groups[1] * groups[2]; }
    bool operator==(const Dispatch&) const = default;

    // A push constant at `offset` bytes.
    template <class T = uint32_t> T constant(size_t offset) const {
        T value{};
        if (offset + sizeof value <= constants.size()) std::memcpy(&value, constants.data() + offset, sizeof value);
        return value;
    }
};
inline void PrintTo(const Dispatch& d, std::ostream* out) {
    *out << d.pass << ": pipeline " << d.pipeline << ", " << d.groups[0] << " x " << d.groups[1] << " x " << d.groups[2];
    *out << " workgroups, constants";
    for (size_t i = 0; i + 4 <= d.constants.size(); i += 4) *out << " " << d.constant(i);
}

// Entry points that create an object, with the types of its create info and handle.
// clang-format off
#define OBSCURA_CREATING(X) \
    X(AllocateMemory, VkMemoryAllocateInfo, VkDeviceMemory) X(CreateImage, VkImageCreateInfo, VkImage) \
    X(CreateImageView, VkImageViewCreateInfo, VkImageView) X(CreateBuffer, VkBufferCreateInfo, VkBuffer) \
    X(CreateSampler, VkSamplerCreateInfo, VkSampler) X(CreateQueryPool, VkQueryPoolCreateInfo, VkQueryPool) \
    X(CreateDescriptorPool, VkDescriptorPoolCreateInfo, VkDescriptorPool) \
    X(CreatePipelineLayout, VkPipelineLayoutCreateInfo, VkPipelineLayout)
// clang-format on
// Other counted entry points.
// clang-format off
#define OBSCURA_COUNTING(X) \
    X(CreateShaderModule) X(CreateComputePipelines) X(CreateGraphicsPipelines) \
    X(CmdBeginDebugUtilsLabelEXT) X(CmdEndDebugUtilsLabelEXT) X(CmdBindPipeline) X(CmdPushConstants) X(CmdDispatch) X(CmdDraw) \
    X(CmdDrawIndexed) X(CmdWriteTimestamp2) X(CmdPipelineBarrier2) X(GetQueryPoolResults)
// clang-format on

class VulkanCounter {
public:
    explicit VulkanCounter(gpu::Device& device) : m_table(const_cast<gpu::Api&>(device.vk())) {  // every Device object is non-const
        s_real = m_table;
        s_current = this;
#define OBSCURA_HOOK(name) \
    if (m_table.name) m_table.name = &VulkanCounter::name;
#define OBSCURA_HOOK_CREATING(name, Info, Handle) OBSCURA_HOOK(name)
        OBSCURA_COUNTING(OBSCURA_HOOK)
        OBSCURA_CREATING(OBSCURA_HOOK_CREATING)
#undef OBSCURA_HOOK_CREATING
#undef OBSCURA_HOOK
    }
    ~VulkanCounter() {
        m_table = s_real;
        s_current = nullptr;
    }
    VulkanCounter(const VulkanCounter&) = delete;

    // For a library on the same device, which must be destroyed before the counter.
    static PFN_vkVoidFunction VKAPI_CALL instanceProc(VkInstance instance, const char* name) {
        if (!std::strcmp(name, "vkGetDeviceProcAddr")) return reinterpret_cast<PFN_vkVoidFunction>(&deviceProc);
        return s_real.GetInstanceProcAddr(instance, name);
    }

    // Since construction or clear().
    std::vector<Dispatch> dispatches;
    std::vector<std::string> events;  // in recording order: "pass NAME", "end", "timestamp", "full barrier", "barrier", "dispatch", "draw"
    std::map<std::string, uint64_t> created;  // objects by entry point
    void clear() {
        dispatches.clear();
        events.clear();
        created.clear();
    }
    // Dispatches whose pass begins with `prefix`.
    std::vector<Dispatch> dispatchesOf(const std::string& prefix) const {
        std::vector<Dispatch> result;
        for (const Dispatch& d : dispatches)
            if (d.pass.starts_with(prefix)) result.push_back(d);
        return result;
    }
    uint64_t workgroups() const {
        uint64_t sum = 0;
        for (const Dispatch& d : dispatches) sum += d.workgroups();
        return sum;
    }
    // Overrides the timestamp values read from query pools.
    std::function<void(std::span<uint64_t>)> ticks;
    uint32_t queryReads = 0;  // calls of vkGetQueryPoolResults, with any result

private:
    static inline gpu::Api s_real;
    static inline VulkanCounter* s_current = nullptr;
    static inline std::map<VkShaderModule, uint32_t> s_loopsOfModule;
    static inline std::map<VkPipeline, uint32_t> s_loops;
    gpu::Api& m_table;
    Dispatch m_next;  // label, pipeline and constants so far

    static PFN_vkVoidFunction VKAPI_CALL deviceProc(VkDevice device, const char* name) {
        const PFN_vkVoidFunction found = s_real.GetDeviceProcAddr(device, name);
        if (!found) return nullptr;
        // clang-format off
#define OBSCURA_FIND(function) \
        if (!std::strcmp(name, "vk" #function)) return reinterpret_cast<PFN_vkVoidFunction>(&VulkanCounter::function);
// clang-format on
#define OBSCURA_FIND_CREATING(function, Info, Handle) OBSCURA_FIND(function)
        OBSCURA_COUNTING(OBSCURA_FIND)
        OBSCURA_CREATING(OBSCURA_FIND_CREATING)
#undef OBSCURA_FIND_CREATING
#undef OBSCURA_FIND
        return found;
    }

    // clang-format off
#define OBSCURA_COUNT_CREATING(name, Info, Handle)                                                                               \
    static VKAPI_ATTR VkResult VKAPI_CALL name(VkDevice device, const Info* info, const VkAllocationCallbacks* host, Handle* made) { \
        ++s_current->created[#name];                                                                                             \
        return s_real.name(device, info, host, made);                                                                            \
    }
    // clang-format on
    OBSCURA_CREATING(OBSCURA_COUNT_CREATING)
#undef OBSCURA_COUNT_CREATING

    static uint32_t loopsOf(std::span<const uint32_t> spirv) {
        constexpr uint32_t kHeader = 5, kLoopMerge = 246;  // words; opcode [SPIR-V, 3.42.17]
        uint32_t count = 0;
        for (size_t at = kHeader; at < spirv.size() && spirv[at] >> 16; at += spirv[at] >> 16) count += (spirv[at] & 0xffff) == kLoopMerge;
        return count;
    }
    static VKAPI_ATTR VkResult VKAPI_CALL CreateShaderModule(
        VkDevice device, const VkShaderModuleCreateInfo* info, const VkAllocationCallbacks* host, VkShaderModule* made) {
        ++s_current->created["CreateShaderModule"];
        const VkResult result = s_real.CreateShaderModule(device, info, host, made);
        if (result == VK_SUCCESS) s_loopsOfModule[*made] = loopsOf({info->pCode, info->codeSize / 4});
        return result;
    }
    static VKAPI_ATTR VkResult VKAPI_CALL CreateComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
        const VkComputePipelineCreateInfo* infos, const VkAllocationCallbacks* host, VkPipeline* made) {
        s_current->created["CreateComputePipelines"] += count;
        const VkResult result = s_real.CreateComputePipelines(device, cache, count, infos, host, made);
        for (uint32_t i = 0; result == VK_SUCCESS && i < count; ++i) s_loops[made[i]] = s_loopsOfModule[infos[i].stage.module];
        return result;
    }
    static VKAPI_ATTR VkResult VKAPI_CALL CreateGraphicsPipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
        const VkGraphicsPipelineCreateInfo* infos, const VkAllocationCallbacks* host, VkPipeline* made) {
        s_current->created["CreateGraphicsPipelines"] += count;
        return s_real.CreateGraphicsPipelines(device, cache, count, infos, host, made);
    }
    static VKAPI_ATTR void VKAPI_CALL CmdBeginDebugUtilsLabelEXT(VkCommandBuffer cmd, const VkDebugUtilsLabelEXT* label) {
        s_current->m_next.pass = label->pLabelName;
        s_current->events.push_back("pass " + s_current->m_next.pass);
        s_real.CmdBeginDebugUtilsLabelEXT(cmd, label);
    }
    static VKAPI_ATTR void VKAPI_CALL CmdEndDebugUtilsLabelEXT(VkCommandBuffer cmd) {
        s_current->m_next.pass.clear();
        s_current->events.push_back("end");
        s_real.CmdEndDebugUtilsLabelEXT(cmd);
    }
    static VKAPI_ATTR void VKAPI_CALL CmdBindPipeline(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipeline pipeline) {
        s_current->m_next.pipeline = pipeline;
        s_current->m_next.loops = s_loops[pipeline];
        s_current->m_next.constants.clear();
        s_real.CmdBindPipeline(cmd, point, pipeline);
    }
    static VKAPI_ATTR void VKAPI_CALL CmdPushConstants(
        VkCommandBuffer cmd, VkPipelineLayout layout, VkShaderStageFlags stages, uint32_t offset, uint32_t bytes, const void* values) {
        std::vector<std::byte>& constants = s_current->m_next.constants;
        constants.resize(std::max(constants.size(), size_t(offset) + bytes));
        std::memcpy(constants.data() + offset, values, bytes);
        s_real.CmdPushConstants(cmd, layout, stages, offset, bytes, values);
    }
    static VKAPI_ATTR void VKAPI_CALL CmdDispatch(VkCommandBuffer cmd, uint32_t x, uint32_t y, uint32_t z) {
        s_current->m_next.groups = {x, y, z};
        s_current->dispatches.push_back(s_current->m_next);
        s_current->events.push_back("dispatch");
        s_real.CmdDispatch(cmd, x, y, z);
    }
    static VKAPI_ATTR void VKAPI_CALL CmdDraw(
        VkCommandBuffer cmd, uint32_t vertices, uint32_t instances, uint32_t firstVertex, uint32_t firstInstance) {
        s_current->events.push_back("draw");
        s_real.CmdDraw(cmd, vertices, instances, firstVertex, firstInstance);
    }
    static VKAPI_ATTR void VKAPI_CALL CmdDrawIndexed(
        VkCommandBuffer cmd, uint32_t indices, uint32_t instances, uint32_t firstIndex, int32_t vertexOffset, uint32_t firstInstance) {
        s_current->events.push_back("draw");
        s_real.CmdDrawIndexed(cmd, indices, instances, firstIndex, vertexOffset, firstInstance);
    }
    static VKAPI_ATTR void VKAPI_CALL CmdWriteTimestamp2(
        VkCommandBuffer cmd, VkPipelineStageFlags2 stage, VkQueryPool pool, uint32_t query) {
        s_current->events.push_back("timestamp");
        s_real.CmdWriteTimestamp2(cmd, stage, pool, query);
    }
    static VKAPI_ATTR void VKAPI_CALL CmdPipelineBarrier2(VkCommandBuffer cmd, const VkDependencyInfo* info) {
        constexpr VkAccessFlags2 kAny = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
        bool full = false;
        for (uint32_t i = 0; i < info->memoryBarrierCount; ++i) {
            const VkMemoryBarrier2& b = info->pMemoryBarriers[i];
            full |= b.srcStageMask == VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT && b.dstStageMask == b.srcStageMask && b.srcAccessMask == kAny &&
                    b.dstAccessMask == kAny;
        }
        s_current->events.push_back(full ? "full barrier" : "barrier");
        s_real.CmdPipelineBarrier2(cmd, info);
    }
    static VKAPI_ATTR VkResult VKAPI_CALL GetQueryPoolResults(VkDevice device, VkQueryPool pool, uint32_t first, uint32_t count,
        size_t bytes, void* data, VkDeviceSize stride, VkQueryResultFlags flags) {
        const VkResult result = s_real.GetQueryPoolResults(device, pool, first, count, bytes, data, stride, flags);
        ++s_current->queryReads;
        if (result == VK_SUCCESS && s_current->ticks) s_current->ticks({static_cast<uint64_t*>(data), count});
        return result;
    }
};
#undef OBSCURA_COUNTING
#undef OBSCURA_CREATING

}  // namespace obscura::test
