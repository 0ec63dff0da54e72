// Descriptor sets of one frame in flight, reset together when the frame is recorded again.
#pragma once

#include <vector>

#include "gpu/device.h"

namespace obscura::gpu {

class DescriptorPool {
public:
    explicit DescriptorPool(Device& device) : m_device(device) {}
    ~DescriptorPool();
    DescriptorPool(const DescriptorPool&) = delete;

    void reset();                                            // the frame that used its sets has left the GPU
    VkDescriptorSet allocate(VkDescriptorSetLayout layout);  // null if there is no memory

private:
    bool grow();
    Device& m_device;
    std::vector<VkDescriptorPool> m_pools;
    size_t m_current = 0;
};

}  // namespace obscura::gpu
