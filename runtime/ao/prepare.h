// Turns whatever a host or the sample has into what every method reads: linear depth and packed eye-space normals.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

// The frame's images as they stand in the graph; formats and encodings are said by the Frame beside them.
struct Sources {
    graph::ImageId depth;
    graph::ImageId normals;  // none: reconstructed from depth
    graph::ImageId motion;   // none: no motion; scaled as the Frame says
    bool direct = false;     // depth and normals have the form of Inputs already and may be storage images: taken as they are
    LayerSources layers;     // none: no depth layers
    graph::BufferId volume;  // none: no volume; bits as Frame::volume describes them
};

// The view that a frame's size, guard band and projection describe. The depth convention (standard, reversed, infinite,
// orthographic, off-centre, flipped y) is read off the matrix. Status::invalid with a reason when it is no projection.
Status viewOf(const Frame& frame, shared::View& view, const char*& reason);

// The volume block that Frame::volume describes, its buffer aside. Status::invalid with a reason when it is no volume.
Status volumeOf(const Volume& volume, shared::Volume& block, const char*& reason);

// Linear depth of sky in Inputs::depth; view.skyDepth is at most this.
inline constexpr float kSkyDepth = 1.0e8f;

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
