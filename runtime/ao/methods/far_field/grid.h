// The grids that scans of far_field and mipmap write.
#pragma once

#include <vector>

#include "ao/far_field/constants.h"
#include "ao/method.h"

namespace obscura::ao {

enum class Averaging : uint32_t { none, prefixSums, pyramid, direct };  // direct: points are single texels, no scan

// The grids of K directions over the image, all levels, consecutive in one image.
struct FarFieldGrid {
    std::vector<shared::Direction> directions;
    uint32_t interval = 0;  // B0, px; widened until the image fits kMostBytes and mostRows
    uint32_t levels = 1;
    VkFormat format = VK_FORMAT_R32_UINT;  // of a cell: a point or a prefix sum
    uint32_t rows = 0;                     // of kCellsWide cells
    uint64_t bytes = 0;
    uint32_t lines = 0, intervals = 0;  // maximum over directions
};
inline constexpr uint64_t kMostBytes = 1u << 28;  // of the cells
// Sets from, step, slope and perRise of the directions, for points on the image plane of a view. slope: s where no view ray is too flat.
void setAxes(FarFieldGrid& grid, const shared::View& view, float slope);
// size: px, guard band included; interval, lineStep: px; mostRows: of an image on the device.
FarFieldGrid farFieldGrid(
    shared::uvec2 size, uint32_t directions, uint32_t interval, uint32_t lineStep, Averaging averaging, uint32_t mostRows);

}  // namespace obscura::ao
