// How a pass may touch a resource, and what Vulkan calls it: one enum, one table. The access of a shader's resource
// follows from its reflected descriptor, so that C++ cannot contradict the shader.
#pragma once

#include "gpu/shader.h"

namespace obscura::graph {

enum class Access : uint8_t {
    none,
    sampled,           // texture
    storageRead,       // readonly image or buffer
    storageWrite,      // writeonly
    storageReadWrite,  // atomics, in place
    uniform,
    color,      // attachment, load or clear and store
    depth,      // attachment, tested and written
    depthTest,  // attachment, tested only
    vertex,
    index,
    transferRead,
    transferWrite,
    present,
    hostRead,
};

struct AccessInfo {
    const char* name;
    VkPipelineStageFlags2 stages;  // 0: the shader stages of the pass
    VkAccessFlags2 access;
    VkImageLayout layout;
    VkImageUsageFlags imageUsage;
    bool writes;
};
const AccessInfo& info(Access access);
Access accessOf(const gpu::Binding& binding);

}  // namespace obscura::graph
