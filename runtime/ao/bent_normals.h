// Bent normals from what a method leaves of the hemisphere: the mean direction of unblocked light, cosine-weighted
// [Landis 2002, Production-Ready Global Illumination]. Per pixel a method gives the blocked part B of the hemisphere's mean direction,
//     B = 1/pi integral of (1 - V(w)) (n.w) w dw,   so that the bent normal is normalised (2/3 n - B),
// because 1/pi integral of (n.w) w dw over the hemisphere is 2/3 n. B is averaged over the tile of pixels that share a method's noise or
// directions, weighted by distance to the tangent plane and by normals, and n is the pixel's own, so curved surfaces keep their shape.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

class BentNormals {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, BentNormals& out);
    // visibility: R16F, visible size. Returns R8G8B8A8_SNORM, visible size: xyz the bent normal, eye space, unit length; w visibility.
    // `reduced`: the picture's pixels, each way, per pixel of the resolution that the method worked at (reduction.h).
    // Sky: 0, 0, 0, 1. Where nothing is unblocked: the normal.
    graph::ImageId add(
        graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const RawBentNormals& raw, uint32_t reduced = 1);

private:
    gpu::Program m_program;
};

}  // namespace obscura::ao
