// Methods at a part of the resolution: depth, normals and layers of every `scale`th pixel, each way, and the way back along surfaces.
#pragma once

#include "ao/crop.h"
#include "ao/method.h"

namespace obscura::ao {

class Reduction {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Reduction& out);
    // The same frame of fewer pixels, each a pixel of the frame, not a mean of several, so that it has its place, depth and normal.
    // The visible part has the frame's size over `scale`, rounded up. The same pixels are taken in every frame: where they changed, history
    // had little less error and flickered up to twice as much.
    // No depth, logged: a pipeline cannot be made.
    Inputs reduce(gpu::Device& device, const gpu::ShaderLibrary& shaders, graph::Graph& graph, const Inputs& inputs, uint32_t scale);
    // visibility: R16F, the visible size of `reduced`. Returns R16F of the visible size of `inputs`: the mean of the nearest reduced pixels
    // that are on the pixel's surface, by distance.
    graph::ImageId enlarge(graph::Graph& graph, const Inputs& inputs, const Inputs& reduced, uint32_t scale, graph::ImageId visibility);

private:
    gpu::Program m_reduce, m_enlarge;
    Crop m_layers;
};

}  // namespace obscura::ao
