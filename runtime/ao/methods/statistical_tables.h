// The summed-area tables of the statistical method: positions in fixed point, split into layers, one table for every other
// layer. Made anew each frame.
#pragma once

#include "ao/statistical/fixed_point.h"
#include "ao/summed_area.h"

namespace obscura::ao {

class StatisticalTables {
public:
    struct Tables {
        shared::Box box;           // as asked for; texels may be larger, see add()
        shared::uvec2 size;        // texels
        graph::BufferId extent;    // Extent of fixed_point.h
        graph::BufferId texels;    // uvec4: sums of x, y, z in units, and count
        graph::BufferId codes;     // uint a texel: bit k is set where it is the nearer at level k + 1; or its uniform layer
        graph::BufferId root;      // table of all texels
        // Tables of the nearer layers, by level: of 1 (code & 1 == 1), 2 (11, 10 of the lowest bits, last level first) and 4
        // (111, 101, 110, 100) interleaved layers. Beyond the levels asked for the root stands in.
        graph::BufferId levels[3];
    };

    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, StatisticalTables& out);
    // Passes extent, texels, root, and for each of 0..3 levels layers and table. Where the device cannot bind a table that
    // large, texels are twice as large.
    Tables add(graph::Graph& graph, const Inputs& inputs, shared::Box box, uint32_t levels);
    // Codes become the numbers of uniform layers; then the table of layers k and k + 1 into `pair`, of bytes(size, 2).
    void addUniform(graph::Graph& graph, const Inputs& inputs, const Tables& tables, uint32_t layers);
    void addPair(graph::Graph& graph, const Tables& tables, uint32_t k, graph::BufferId pair);

private:
    void addCodes(graph::Graph& graph, const Inputs& inputs, const Tables& tables, uint32_t level, uint32_t uniformLayers, const std::string& name);
    SummedArea m_sums;
    gpu::Program m_extentBlocks, m_extent, m_texels;
    gpu::Program m_layers[4];     // by level; 0: uniform layers
    uint64_t m_largest = 0;       // bytes of a buffer that can be bound
};

}  // namespace obscura::ao
