// What the executor owns. Internal to runtime/graph.
#pragma once

#include "gpu/descriptor_pool.h"
#include "gpu/timestamps.h"
#include "graph/executor.h"

namespace obscura::graph {

struct Executor::Physical {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;  // all mips
    const gpu::Image* owned = nullptr;  // for views of single mips; null for imported images
    ExternalBuffer buffer;
    VkImageView mip(uint32_t level) const { return owned ? owned->mipView(level) : view; }
};

struct Executor::Pooled {
    Slot slot;
    gpu::Image image;       // this
    gpu::Buffer buffer;     // or this
    std::string name;       // debug name
    uint64_t lastUsed = 0;  // device frame
};

// A history's images that were made anew, until the frame is recorded.
struct Executor::Pending {
    gpu::Image images[2];  // empty: the history's own serves
};

// What one frame in flight holds until its turn comes again.
struct Executor::Frame {
    explicit Frame(gpu::Device& device) : sets(device), timestamps(device) {}
    std::vector<gpu::Buffer> uploads;
    gpu::DescriptorPool sets;
    gpu::Timestamps timestamps;
    std::vector<std::string> passNames;  // one between each two timestamps
    uint64_t number = 0;
};

}  // namespace obscura::graph
