// Copies a part of a host's image into an image of its own, since methods read images from their upper left pixel on.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

class Crop {
public:
    enum class Texel : uint8_t { floats2, floats4, integer };
    // Adds a pass that copies `size` pixels from `origin` on. No image, logged: its pipeline cannot be made.
    graph::ImageId add(gpu::Device& device, const gpu::ShaderLibrary& shaders, graph::Graph& graph, graph::ImageId source,
        VkOffset2D origin, VkExtent2D size, Texel texel);

private:
    gpu::Program m_programs[3];  // by Texel, made on first use
};

}  // namespace obscura::ao
