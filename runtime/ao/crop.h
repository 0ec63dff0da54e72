// Copies a part of a host's image into an image of its own, since methods read images of one sample from their upper left pixel on.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

class Crop {
public:
    enum class Texel : uint8_t { floats2, floats4, integer };
    // Adds a pass that copies `size` pixels, every `stride`th from `origin` on, each way. `half`: the source has a texel for every other
    // pixel. `multisampled`: the first sample of each is taken. No image, logged: its pipeline cannot be made.
    graph::ImageId add(gpu::Device& device, const gpu::ShaderLibrary& shaders, graph::Graph& graph, graph::ImageId source,
        VkOffset2D origin, VkExtent2D size, Texel texel, uint32_t stride = 1, bool half = false, bool multisampled = false);

private:
    gpu::Program m_programs[6];  // by Texel, the first three of one sample; made on first use
};

}  // namespace obscura::ao
