// Summed-area tables of the statistical method: positions in fixed point, split into layers, with a table for every other layer.
// Computed every frame.
#pragma once

#include "ao/statistical/fixed_point.h"
#include "ao/summed_area.h"

namespace obscura::ao {

class StatisticalTables {
public:
    struct Tables {
        shared::Box box;         // as passed to add(), except that texels may be larger
        shared::uvec2 size;      // texels
        graph::BufferId extent;  // Extent of fixed_point.h
        graph::BufferId texels;  // uvec4: sums of x, y, z in units, and count
        graph::BufferId codes;   // uint a texel: bit k is set if it is in the nearer layer at level k + 1; or its uniform layer's number
        graph::BufferId root;    // table of all texels
        // Tables of the nearer layers, by level: of 1 (code & 1 == 1), 2 (11, 10 of the lowest bits, last level first) and 4
        // (111, 101, 110, 100) interleaved layers. Levels that were not requested are `root`.
        graph::BufferId levels[3];
    };

    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, StatisticalTables& out);
    // Passes: extent, texels, root, and for each of 0 to 3 levels layers and table. Texels double in size, with a warning, until the device
    // can bind the tables.
    Tables add(graph::Graph& graph, const Inputs& inputs, shared::Box box, uint32_t levels);
    // addUniform(): `codes` become numbers of uniform layers. addPair(): writes the table of layers k and k + 1 to `pair`, of
    // bytes(size, 2).
    void addUniform(graph::Graph& graph, const Inputs& inputs, const Tables& tables, uint32_t layers);
    void addPair(graph::Graph& graph, const Tables& tables, uint32_t k, graph::BufferId pair);

private:
    void addCodes(
        graph::Graph& graph, const Inputs& inputs, const Tables& tables, uint32_t level, uint32_t uniformLayers, const std::string& name);
    SummedArea m_sums;
    gpu::Program m_extentBlocks, m_extent, m_texels;
    gpu::Program m_layers[4];  // by level; 0: uniform layers
    uint64_t m_largest = 0;    // largest storage buffer that the device can bind, bytes
    bool m_warned = false;     // that texels are larger than asked for
};

}  // namespace obscura::ao
