// Summed-area tables [Crow 1984] of four 32-bit channels: two passes of prefix sums, along rows and down columns. Integers wrap modulo
// 2^32: a window's sum is exact if that sum itself fits in 32 bits, even if table entries have wrapped.
//
// Layout. Texels: uvec4, rows of size.x, tightly packed. Table: (size.x + 1) x (size.y + 1) entries of `layers` uvec4 each;
// entry (x, y) holds for each layer the sum of the texels left of x and above y, so row 0 and column 0 are zero and the
// window [x0, x1) x [y0, y1) sums to t(x1,y1) - t(x0,y1) - t(x1,y0) + t(x0,y0).
#pragma once

#include <span>

#include "ao/method.h"

namespace obscura::ao {

class SummedArea {
public:
    // Which texels a layer sums: those with (code & mask) == value.
    struct Layer {
        uint32_t mask, value;
    };
    static constexpr uint32_t kMostLayers = 4;

    // blocks: number of invocations that share a line, 1 to 16; 0: 1 on software devices, else 16.
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, SummedArea& out, uint32_t blocks = 0);
    static uint64_t bytes(shared::uvec2 size, size_t layers) { return uint64_t(size.x + 1) * (size.y + 1) * layers * 16; }

    // Fills `table`, of bytes(size, layers), in passes "NAME rows" and "NAME columns". `codes`: one uint a texel. Without codes there is
    // one layer, of all texels.
    void add(graph::Graph& graph, const std::string& name, graph::BufferId texels, graph::BufferId table, shared::uvec2 size);
    void add(graph::Graph& graph, const std::string& name, graph::BufferId texels, graph::BufferId codes, graph::BufferId table,
        shared::uvec2 size, std::span<const Layer> layers);

private:
    gpu::Program m_rows;
    gpu::Program m_columns;
};

}  // namespace obscura::ao
