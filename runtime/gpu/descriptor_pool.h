// Descriptor sets of one frame in flight, reset together when the frame is recorded again.
#pragma once

#include <span>
#include <vector>

#include "gpu/program.h"

namespace obscura::gpu {

// What a binding is filled with: an image or a buffer, as its kind says.
struct Descriptor {
    VkDescriptorImageInfo image;
    VkDescriptorBufferInfo buffer;
};

class DescriptorPool {
public:
    explicit DescriptorPool(Device& device) : m_device(device) {}
    ~DescriptorPool();
    DescriptorPool(const DescriptorPool&) = delete;

    bool reserve(uint32_t sets);  // makes pools for so many in a frame; false: no memory
    void reset();                 // the frame that used its sets has left the GPU
    // A set of a program, its bindings filled in their order. Null if there is no memory.
    VkDescriptorSet make(const Program& program, uint32_t set, std::span<const Descriptor> contents);

private:
    VkDescriptorSet allocate(VkDescriptorSetLayout layout);
    bool grow();
    Device& m_device;
    std::vector<VkDescriptorPool> m_pools;
    size_t m_current = 0;
};

}  // namespace obscura::gpu
