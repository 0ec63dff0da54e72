// Interleaving: pixels of a tile share directions or samples.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

// Interleaving [Timonen 2013, sec. 10], for methods whose work splits by direction or sample: a pixel evaluates its share, 1/n^2 of them
// (see shaders/ao/common/tile.glsl), and averages the shares of those n x n pixels around it that show its surface.
inline constexpr const char* kInterleaves[] = {"off", "2x2", "3x3", "4x4"};
inline constexpr Parameter kInterleave{"interleave", "", 0, 3, 0, true, {kInterleaves, 4},
    "Each pixel of a tile evaluates a share of the directions and averages its neighbours' on the same surface. Cost falls with the tile's "
    "area; larger tiles blur."};
uint32_t tileSide(const Values& values);                 // n; 1: off
uint32_t sharedOut(uint32_t directions, uint32_t side);  // rounded up, so that every pixel has as many

class Gather {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Gather& out);
    // shares: visibility of each pixel's share, R16F, visible size. With `open`, RG16F (weight x obscurance, weight), whose mean is taken
    // off that visibility. Returns visibility, R16F.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, graph::ImageId shares, uint32_t side, graph::ImageId open = {});
    // The same over a map (upsample.h) of visibility, its receivers and how many of the picture's pixels one of its stands for, each way.
    graph::ImageId addMap(
        graph::Graph& graph, const Inputs& inputs, graph::ImageId shares, graph::ImageId receivers, uint32_t scale, uint32_t side);

private:
    gpu::Program m_equal, m_weighted, m_map;
};

}  // namespace obscura::ao
