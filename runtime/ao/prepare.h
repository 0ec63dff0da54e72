// Prepares a frame's images for the methods: linear depth and packed eye-space normals.
#pragma once

#include "ao/method.h"
#include "ao/view.h"

namespace obscura::ao {

// The frame's images in the graph. Formats and encodings are those of the Frame.
struct Sources {
    graph::ImageId depth;
    graph::ImageId normals;  // none: reconstructed from depth
    graph::ImageId motion;   // none: no motion; scaled as the Frame says
    bool direct = false;     // depth and normals have the form of Inputs already and may be storage images: taken as they are
    LayerInputs layers;      // none: no depth layers
    graph::BufferId volume;  // none: no volume; bits as Frame::volume describes them
    bool packed = false;     // normals have the form of Inputs already
};

class Prepare {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Prepare& out);
    Inputs add(graph::Graph& graph, const Frame& frame, const shared::View& view, const Sources& sources, const Falloff& falloff);

private:
    gpu::Program m_linearize;
    gpu::Program m_packNormals;
    gpu::Program m_repackNormals;
    gpu::Program m_reconstruct;
};

}  // namespace obscura::ao
