// XeGTAO's spatial denoiser: a 3x3 blur that stops at depth edges, applied twice (5x5). For the baseline methods published with it; other
// methods use Denoise, which is weighted by depth and normal.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

class EdgeBlur {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, EdgeBlur& out);
    // noisy: R32UI, visible size, packed by ao/common/edges.glsl. Returns visibility, R16F; not `on`: unblurred, to 0.001.
    graph::ImageId add(graph::Graph& graph, graph::ImageId noisy, bool on, const char* passName);

private:
    gpu::Program m_blur[2];  // first pass, last pass
};

}  // namespace obscura::ao
