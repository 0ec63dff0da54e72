#include "app/frames.h"

#include <chrono>

namespace obscura::app {

double now() { return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Frames::Frames(gpu::Device& device) : m_device(device), m_executor(device), m_slots(device.framesInFlight()) {
    const gpu::Api& vk = device.vk();
    for (Slot& slot : m_slots) {
        const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
            .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
            .queueFamilyIndex = device.queueFamily()};
        m_valid = m_valid && vk.CreateCommandPool(device.handle(), &pool, device.allocator(), &slot.pool) == VK_SUCCESS;
        if (!m_valid) return;
        const VkCommandBufferAllocateInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
            .commandPool = slot.pool,
            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
            .commandBufferCount = 1};
        const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        m_valid = vk.AllocateCommandBuffers(device.handle(), &commands, &slot.commands) == VK_SUCCESS &&
                  vk.CreateFence(device.handle(), &fence, device.allocator(), &slot.fence) == VK_SUCCESS;
    }
}

Frames::~Frames() {
    wait();
    const gpu::Api& vk = m_device.vk();
    for (const Slot& slot : m_slots) {
        vk.DestroyFence(m_device.handle(), slot.fence, m_device.allocator());
        vk.DestroyCommandPool(m_device.handle(), slot.pool, m_device.allocator());
    }
}

gpu::Status Frames::wait(Slot& slot) {
    if (!slot.submitted) return gpu::Status::ok;
    const gpu::Api& vk = m_device.vk();
    slot.submitted = false;
    const VkResult result = vk.WaitForFences(m_device.handle(), 1, &slot.fence, VK_TRUE, UINT64_MAX);
    vk.ResetFences(m_device.handle(), 1, &slot.fence);
    return gpu::fromVulkan(result);
}

gpu::Status Frames::wait() {
    gpu::Status status = gpu::Status::ok;
    for (Slot& slot : m_slots)
        if (const gpu::Status s = wait(slot); s != gpu::Status::ok) status = s;
    return status;
}

gpu::Status Frames::begin(graph::Graph& graph) {
    m_slot = (m_slot + 1) % uint32_t(m_slots.size());
    Slot& slot = m_slots[m_slot];
    if (const gpu::Status status = wait(slot); status != gpu::Status::ok) return status;
    m_begun = now();
    m_device.nextFrame();
    const gpu::Api& vk = m_device.vk();
    const VkCommandBufferBeginInfo info{
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    VkResult result = vk.ResetCommandPool(m_device.handle(), slot.pool, 0);
    if (result == VK_SUCCESS) result = vk.BeginCommandBuffer(slot.commands, &info);
    if (result != VK_SUCCESS) return gpu::fromVulkan(result);
    graph.begin(&m_executor.timings());
    return gpu::Status::ok;
}

gpu::Status Frames::end(graph::Graph& graph, VkSemaphore waitFor, VkSemaphore signal) {
    Slot& slot = m_slots[m_slot];
    const gpu::Api& vk = m_device.vk();
    if (const gpu::Status status = m_executor.execute(graph, slot.commands); status != gpu::Status::ok) return status;
    if (const VkResult result = vk.EndCommandBuffer(slot.commands); result != VK_SUCCESS) return gpu::fromVulkan(result);

    const VkSemaphoreSubmitInfo waits{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO, .semaphore = waitFor, .stageMask = kAcquireStages};
    const VkSemaphoreSubmitInfo signals{
        .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO, .semaphore = signal, .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    const VkCommandBufferSubmitInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, .commandBuffer = slot.commands};
    const VkSubmitInfo2 submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
        .waitSemaphoreInfoCount = waitFor ? 1u : 0u,
        .pWaitSemaphoreInfos = &waits,
        .commandBufferInfoCount = 1,
        .pCommandBufferInfos = &commands,
        .signalSemaphoreInfoCount = signal ? 1u : 0u,
        .pSignalSemaphoreInfos = &signals};
    const VkResult result = vk.QueueSubmit2(m_device.queue(), 1, &submit, slot.fence);
    slot.submitted = result == VK_SUCCESS;
    m_record = now() - m_begun;
    return gpu::fromVulkan(result);
}

}  // namespace obscura::app
