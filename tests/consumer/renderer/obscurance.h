// The renderer's obscurance, by Obscura.
#pragma once

#include <vulkan/vulkan.h>

#include "renderer.h"

namespace obscura::ao { struct Context; }

class Obscurance {
public:
    explicit Obscurance(const Renderer& renderer);
    ~Obscurance();                         // the GPU is done
    bool use(const char* method);          // false: no such method, and a line said so
    struct Picture { VkImage image; VkImageLayout layout; };
    // Visibility of the renderer's depth, 8 bits a pixel; null where something went wrong.
    Picture record(VkCommandBuffer cmd, const Renderer& renderer);

private:
    obscura::ao::Context* m_context = nullptr;
};
