// What all methods share after their own passes: spatial denoising and temporal reprojection.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

// Visibility 1 everywhere, R16F.
graph::ImageId allOpen(graph::Graph& graph, VkExtent2D visible, const char* passName);

// 5x5 Gaussian (6, 4, 1) x max(0, n.n') x 1 / (1 + sharpness |plane distance| / depth): smooths over a surface, keeps its edges. The
// plane distance is that of the neighbour's position from the pixel's tangent plane.
class Denoise {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Denoise& out);
    // visibility: R16F, visible size. Returns a new image of the same kind.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const char* passName);

private:
    gpu::Program m_blur;
};

// What the past may say. The past is last frame's result where the motion vectors lead, bilinear over those of its four pixels
// that show the same surface; `history` is the weight it gets once enough frames agree, 1 - 1/(n + 1) until then.
struct TemporalSettings {
    float history = 0.9f;         // most weight of the past, 0 (off) to 0.98
    float depthTolerance = 0.02f; // how far off the surface's plane a past pixel may lie, in its depths [Hoang 2012, eps]
    float normalTolerance = 0.9f; // least cosine between the normals; -1: any
    float clip = 1.0f;            // past beyond so many standard deviations of the 3x3 around is drawn in: occluders that
                                  // move leave no trail on receivers that do not. 0: off, as in the papers
    float clipFloor = 0.01f;      // and this much visibility more
};

// Temporal reprojection. Wants Inputs::motion; without it visibility passes through. Owns its history: one object a method.
class Temporal {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Temporal& out);
    // visibility: R16F, visible size. Returns a new image of the same kind.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const TemporalSettings& settings, const char* passName);
    void reset();  // the past is void: camera cut, method switch

private:
    gpu::Program m_reproject;
    graph::History m_past;  // RG32UI: linear depth as a float's bits; visibility, frames gathered and normal, see temporal.comp
};

}  // namespace obscura::ao
