// Linear depth at five resolutions, for methods that take far samples from coarse levels so that they stay in the cache
// [McGuire 2012, sec. 2.2]. One R32F image holds them all, since fetching from it is an imageLoad; ao/common/depth_mips.glsl
// says where.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

class DepthMips {
public:
    enum class Filter : uint32_t { oneOfFour, farthest };  // farthest: the mean of those near the farthest, as XeGTAO has it
    static constexpr float kFade = 0.615f;  // XeGTAO's
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Filter filter, DepthMips& out);
    // Of an image that holds all levels of pictures of this size.
    static gpu::ImageDesc desc(VkFormat format, shared::uvec2 size);
    // range, fade: of `farthest`. A depth counts by clamp((range - how much nearer than the farthest it is) / (fade range), 0, 1); metres.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const char* passName, float range = 1.0f, float fade = kFade);

private:
    gpu::Program m_reduce;
};

}  // namespace obscura::ao
