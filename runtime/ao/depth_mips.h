// Linear depth at five resolutions, for methods whose distant samples read coarse levels to stay in the cache [McGuire 2012, sec. 2.2].
// One R32F image holds all levels, so that shaders read it with imageLoad; layout: ao/common/depth_mips.glsl.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

class DepthMips {
public:
    enum class Filter : uint32_t { oneOfFour, farthest };  // farthest: mean of the texels near the farthest [XeGTAO]
    static constexpr float kFade = 0.615f;                 // XeGTAO's
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Filter filter, DepthMips& out);
    // Size of level 0: the buffers', rounded up to whole texels of the coarsest level. Description of the image that holds all levels.
    static shared::uvec2 padded(shared::uvec2 size) { return {(size.x + 15) & ~15u, (size.y + 15) & ~15u}; }
    static gpu::ImageDesc desc(VkFormat format, shared::uvec2 size);
    // range, fade: of `farthest`. A depth d has weight clamp((range - (farthest - d)) / (fade range), 0, 1); metres.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const char* passName, float range = 1.0f, float fade = kFade);

private:
    gpu::Program m_reduce;
};

}  // namespace obscura::ao
