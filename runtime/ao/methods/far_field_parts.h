// What far_field and mipmap share: the falloff's table, and the grids that scans fill.
#pragma once

#include <vector>

#include "ao/far_field/layout.h"
#include "ao/method.h"

namespace obscura::ao {

// The falloff integrated along lines [Timonen 2013, eq. 3, factored into two dimensions]: 128 KB, made by a pass of its own whenever the
// falloff is another than last time, so its kind costs nothing per frame.
class FalloffTable {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffTable& out);
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const char* passName);
    void reset() { m_made = false; }  // it may never have run

private:
    gpu::Program m_program;
    gpu::Image m_table;
    Falloff m_falloff;
    bool m_made = false;
};

enum class Averaging : uint32_t { none, prefixSums, pyramid, direct };  // direct: points are single texels, no scan

// The grids of K directions over a picture, all levels, one after the other in one image.
struct FarFieldGrid {
    std::vector<shared::Direction> directions;
    uint32_t interval = 0;     // B0, px: widened until the image is no larger than allowed
    uint32_t levels = 1;
    VkFormat format = VK_FORMAT_R32_UINT;  // of a cell: a point in two halves, or a prefix sum
    uint32_t rows = 0;         // of kCellsWide cells
    uint64_t bytes = 0;
    uint32_t lines = 0, intervals = 0;  // most of any direction
};
inline constexpr uint64_t kMostBytes = 1u << 28;  // of the cells
// size: px, guard band included; interval, lineStep: px; mostRows: of an image on the device.
FarFieldGrid farFieldGrid(shared::uvec2 size, uint32_t directions, uint32_t interval, uint32_t lineStep, Averaging averaging,
                           uint32_t mostRows);

}  // namespace obscura::ao
