// Spatial denoising: a blur along the surface.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

// 5x5 Gaussian (6, 4, 1) x max(0, n.n') x 1 / (1 + sharpness |plane distance| / depth): smooths along a surface, keeps its edges. The plane
// distance is that of the neighbour's position from the pixel's tangent plane. With temporal reprojection, which averages noise as well, a
// stricter variant keeps more detail.
class Denoise {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Denoise& out);
    // visibility: R16F, visible size. Returns a new image of the same kind.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const char* passName);

private:
    gpu::Program m_blur, m_strict;
};

}  // namespace obscura::ao
