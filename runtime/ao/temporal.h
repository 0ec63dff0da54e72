// Temporal reprojection of visibility.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

// History is last frame's result at the position that the motion vector gives or, without motion, at which last frame's camera saw the
// surface: bilinear over those of its four pixels that show the same surface. Its weight after n frames is 1 - 1/(n + 1), at most
// `history`.
struct TemporalSettings {
    float history = 0.9f;          // largest weight of history, 0 (off) to 0.98
    float depthTolerance = 0.02f;  // largest distance of a history pixel from the surface's plane, over its depth [Hoang 2012, eps]
    float normalTolerance = 0.9f;  // least cosine between the normals; -1: any
    // History is clamped to this many standard deviations of its neighbourhood, so that moving occluders leave no trail on receivers at
    // rest. The deviation is of 3x3 pixels, two apart, after removing their slope, plus the pixel's own change over time. 0: off, as in the
    // papers.
    float clip = 1.5f;
    float clipFloor = 0.01f;  // visibility added to that interval
};

class Temporal {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Temporal& out);
    // visibility: R16F, visible size. Returns a new image of the same kind.
    // `history`: what the last frame left, RG32UI: linear depth and unrest; visibility, frames gathered and normal, see temporal.comp.
    // `discard`: it is not used this frame (camera cut, method switch).
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const TemporalSettings& settings,
        graph::History& history, bool discard, const char* passName);

private:
    gpu::Program m_reproject[2][2];  // by motion image, by orthographic view
};

}  // namespace obscura::ao
