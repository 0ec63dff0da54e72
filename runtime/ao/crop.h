// Copies a part of a host's image into an image of its own, since methods read images of one sample from their upper left pixel on.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

class Crop {
public:
    enum class Texel : uint8_t { floats2, floats4, integer };
    // What is copied of a source: `size` pixels, every `stride`th from `origin` on, each way.
    struct Part {
        VkOffset2D origin;  // px
        VkExtent2D size;    // px of the copy
        uint32_t stride = 1;
        bool half = false;          // the source has a texel for every other pixel
        bool multisampled = false;  // the first sample of each pixel is taken
    };
    // Adds a pass that copies it. No image, logged: its pipeline cannot be made.
    graph::ImageId add(
        gpu::Device& device, const gpu::ShaderLibrary& shaders, graph::Graph& graph, graph::ImageId source, const Part& part, Texel texel);

private:
    gpu::Program m_programs[6];  // by Texel, the first three of one sample; made on first use
};

}  // namespace obscura::ao
