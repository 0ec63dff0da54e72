// Integration of Obscura into the renderer.
#pragma once

#include <vulkan/vulkan.h>

#include "renderer.h"

namespace obscura::ao {
struct Context;
}

class Obscurance {
public:
    explicit Obscurance(const Renderer& renderer);
    ~Obscurance();                 // the GPU must be idle
    bool use(const char* method);  // false: unknown method, logged
    struct Picture {
        VkImage image = VK_NULL_HANDLE;
        VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
        VkImage bentNormals = VK_NULL_HANDLE;  // of methods that have them
    };
    // Visibility of the renderer's depth, 8 bits a pixel; null on failure.
    Picture record(VkCommandBuffer cmd, const Renderer& renderer);
    VkExtent2D largest{};    // dynamic resolution: the largest size of the renderer to come; 0: its sizes are fixed
    uint64_t bytes() const;  // device memory

private:
    obscura::ao::Context* m_context = nullptr;
};
