// Records commands that are never submitted.
#pragma once

#include <gtest/gtest.h>

#include "gpu/device.h"

namespace obscura::test {

// Calls `record(VkCommandBuffer)` between begin and end of a new command buffer, then frees the buffer without submitting it.
template <class Record> void recordAndDrop(gpu::Device& device, Record&& record) {
    const gpu::Api& vk = device.vk();
    const VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, device.queueFamily()};
    VkCommandPool pool = VK_NULL_HANDLE;
    ASSERT_EQ(vk.CreateCommandPool(device.handle(), &poolInfo, nullptr, &pool), VK_SUCCESS);
    const VkCommandBufferAllocateInfo one{
        VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    EXPECT_EQ(vk.AllocateCommandBuffers(device.handle(), &one, &cmd), VK_SUCCESS);
    if (cmd) {
        const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        EXPECT_EQ(vk.BeginCommandBuffer(cmd, &begin), VK_SUCCESS);
        record(cmd);
        EXPECT_EQ(vk.EndCommandBuffer(cmd), VK_SUCCESS);
    }
    vk.DestroyCommandPool(device.handle(), pool, nullptr);
}

}  // namespace obscura::test
