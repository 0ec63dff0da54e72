#include "gpu/timestamps.h"

#include <algorithm>
#include <utility>

#include "gpu/result.h"

namespace obscura::gpu {

Timestamps::~Timestamps() {
    m_device.release(VK_OBJECT_TYPE_QUERY_POOL, m_queries);
    m_device.release(VK_OBJECT_TYPE_EVENT, m_executed);
}

Status Timestamps::reserve(uint32_t count) {
    if (!m_executed) {
        const VkEventCreateInfo info{VK_STRUCTURE_TYPE_EVENT_CREATE_INFO};
        VkEvent event = VK_NULL_HANDLE;
        if (const VkResult made = m_device.vk().CreateEvent(m_device.handle(), &info, m_device.allocator(), &event))
            return fail(m_device, fromVulkan(made), "timestamps: no event that tells whether a frame was executed");
        m_executed = event;
    }
    if (m_capacity >= count) return Status::ok;
    m_device.release(VK_OBJECT_TYPE_QUERY_POOL, std::exchange(m_queries, VK_NULL_HANDLE));
    m_capacity = 0;
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = std::max(64u, count * 2);
    VkQueryPool queries = VK_NULL_HANDLE;
    if (const VkResult made = m_device.vk().CreateQueryPool(m_device.handle(), &info, m_device.allocator(), &queries))
        return fail(m_device, fromVulkan(made), "timestamps: no query pool");
    m_queries = queries;
    m_capacity = info.queryCount;
    return Status::ok;
}

void Timestamps::begin(VkCommandBuffer cmd) {
    m_count = 0;
    m_passes.clear();
    m_device.vk().CmdResetQueryPool(cmd, m_queries, 0, m_capacity);
    write(cmd);
}

void Timestamps::write(VkCommandBuffer cmd, const std::string& pass) {
    write(cmd);
    m_passes.push_back(pass);
}

// A software rasterizer bins a timestamp into work that is flushed later, so that a compute pass after a render pass would
// read near zero; a full barrier behind the timestamp makes it true. Real GPUs need none.
void Timestamps::write(VkCommandBuffer cmd) {
    m_device.vk().CmdWriteTimestamp2(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, m_queries, m_count++);
    if (!m_device.caps().software) return;
    const VkAccessFlags2 any = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    const VkMemoryBarrier2 all{
        VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, any, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, any};
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &all;
    m_device.vk().CmdPipelineBarrier2(cmd, &info);
}

void Timestamps::end(VkCommandBuffer cmd) {
    const VkMemoryBarrier2 all{
        VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0};
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &all;
    m_device.vk().CmdSetEvent2(cmd, m_executed, &info);
}

Status Timestamps::read(std::vector<PassTime>& times) {
    times.clear();
    const uint32_t count = std::exchange(m_count, 0);
    if (count == 0) return Status::ok;
    const Api& vk = m_device.vk();
    const VkResult executed = vk.GetEventStatus(m_device.handle(), m_executed);
    if (executed != VK_EVENT_SET) return executed == VK_ERROR_DEVICE_LOST ? Status::deviceLost : Status::ok;
    if (vk.ResetEvent(m_device.handle(), m_executed) != VK_SUCCESS)
        m_device.release(VK_OBJECT_TYPE_EVENT, std::exchange(m_executed, VK_NULL_HANDLE));
    if (count < 2) return Status::ok;  // a frame without a pass
    std::vector<uint64_t> ticks(count);
    const VkResult result =
        vk.GetQueryPoolResults(m_device.handle(), m_queries, 0, count, ticks.size() * 8, ticks.data(), 8, VK_QUERY_RESULT_64_BIT);
    if (result != VK_SUCCESS) return result == VK_ERROR_DEVICE_LOST ? Status::deviceLost : Status::ok;
    for (uint32_t i = 0; i + 1 < count; ++i)
        times.push_back(
            {m_passes[i], double((ticks[i + 1] - ticks[i]) & m_device.caps().timestampMask) * m_device.caps().timestampPeriod * 1e-6});
    return Status::ok;
}

}  // namespace obscura::gpu
