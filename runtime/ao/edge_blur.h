// XeGTAO's spatial denoiser: a 3x3 blur that edges of depth cut, twice, which makes 5x5. For yardsticks that are published with it; our
// own methods blur along the surface (resolve.h).
#pragma once

#include "ao/method.h"

namespace obscura::ao {

class EdgeBlur {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, EdgeBlur& out);
    // noisy: R32UI, visible size, as ao/common/edges.glsl packs it. Returns visibility, R16F; as it was (to 0.001) when not `on`.
    graph::ImageId add(graph::Graph& graph, graph::ImageId noisy, bool on, const char* passName);

private:
    gpu::Program m_blur[2];  // to blur again, last
};

}  // namespace obscura::ao
