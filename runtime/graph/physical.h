// What stands behind the graph's ids on the GPU. Internal to runtime/graph.
#pragma once

#include "graph/graph.h"

namespace obscura::graph {

struct Graph::Physical {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;             // all mips
    const gpu::Image* owned = nullptr;             // for views of single mips; null for external images
    VkBuffer buffer = VK_NULL_HANDLE;
    uint64_t offset = 0, bytes = 0;
    int poolBuffer = -1;
    VkImageView mip(uint32_t level) const { return owned ? owned->mipView(level) : view; }
};

struct Graph::PoolImage {
    gpu::Image image;
    uint64_t lastUsed = 0;                         // device frame
};

struct Graph::PoolBuffer {
    gpu::Buffer buffer;
    State state;
    uint64_t lastUsed = 0;
    bool taken = false;                            // by this frame's recording
};

// What one frame in flight holds until its turn comes again.
struct Graph::Frame {
    struct Upload { gpu::Buffer buffer; uint64_t bytes = 0, used = 0; };
    std::vector<VkDescriptorPool> pools;
    size_t pool = 0;                               // the one being allocated from
    VkQueryPool queries = VK_NULL_HANDLE;
    VkEvent executed = VK_NULL_HANDLE;             // set by the frame itself: without it the queries were never reset
    uint32_t queryCount = 0, queryCapacity = 0;
    std::vector<std::string> passNames;            // one between each two timestamps
    uint64_t number = 0;
    std::vector<Upload> uploads;
};

}  // namespace obscura::graph
