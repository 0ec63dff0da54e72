// What all methods share after their own passes: spatial denoising and temporal reprojection.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

// Visibility 1 everywhere, R16F.
graph::ImageId allOpen(graph::Graph& graph, VkExtent2D visible, const char* passName);

// 5x5 Gaussian (6, 4, 1) x max(0, n.n') x 1 / (1 + sharpness |plane distance| / depth): smooths over a surface, keeps its edges. The
// plane distance is that of the neighbour's position from the pixel's tangent plane. Where a history averages noise over frames the blur
// has less to do and is stricter, so that it takes fewer details with it.
class Denoise {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Denoise& out);
    // visibility: R16F, visible size. Returns a new image of the same kind.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const char* passName);

private:
    gpu::Program m_blur, m_strict;
};

// Interleaving [Timonen 2013, sec. 10], for methods whose work splits by direction or sample: a pixel does its share of it, 1/n^2 (see
// shaders/ao/common/tile.glsl), and gathers the shares of the n x n pixels around that show its surface.
inline constexpr const char* kInterleaves[] = {"off", "2x2", "3x3", "4x4"};
inline constexpr Parameter kInterleave{"interleave", "", 0, 3, 0, true, {kInterleaves, 4},
                                       "Pixels share out directions among their neighbours on the same surface: a fraction of the cost, a little blur. Directions are rounded up to shares."};
uint32_t tileSide(const Values& values);                    // n; 1: off
uint32_t sharedOut(uint32_t directions, uint32_t side);     // rounded up, so that every pixel has as many

class Gather {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Gather& out);
    // parts: visibility of each pixel's share, R16F, visible size. With `open`, RG16F (weight x obscurance, weight), whose mean is taken
    // off that visibility. Returns visibility, R16F.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, graph::ImageId parts, uint32_t side, graph::ImageId open = {});
    // The same over a map (upsample.h) of visibility, its receivers and how many of the picture's pixels one of its stands for, each way.
    graph::ImageId addMap(graph::Graph& graph, const Inputs& inputs, graph::ImageId parts, graph::ImageId receivers, uint32_t scale, uint32_t side);

private:
    gpu::Program m_equal, m_weighted, m_map;
};

// What the past may say. The past is last frame's result where the motion vectors lead, bilinear over those of its four pixels
// that show the same surface; `history` is the weight it gets once enough frames agree, 1 - 1/(n + 1) until then.
struct TemporalSettings {
    float history = 0.9f;         // most weight of the past, 0 (off) to 0.98
    float depthTolerance = 0.02f; // how far off the surface's plane a past pixel may lie, in its depths [Hoang 2012, eps]
    float normalTolerance = 0.9f; // least cosine between the normals; -1: any
    float clip = 1.5f;            // past beyond so many standard deviations of the present is drawn in: occluders that move leave no
                                  // trail on receivers that do not. They are of 3x3 pixels, two apart, off their slope, and of what the
                                  // pixel has kept changing by. 0: off, as in the papers
    float clipFloor = 0.01f;      // and this much visibility more
};

// Temporal reprojection. Wants Inputs::motion; without it visibility passes through. Owns its history; the
// library has one, and voids it when the method is another.
class Temporal {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Temporal& out);
    // visibility: R16F, visible size. Returns a new image of the same kind.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const TemporalSettings& settings, const char* passName);
    void reset();  // the past is void: camera cut, method switch

private:
    gpu::Program m_reproject;
    graph::History m_past;  // RG32UI: linear depth and unrest; visibility, frames gathered and normal, see temporal.comp
};

}  // namespace obscura::ao
