// The grids that scans of far_field and mipmap write.
#pragma once

#include <vector>

#include "ao/far_field/constants.h"
#include "ao/method.h"

namespace obscura::ao {

enum class Averaging : uint32_t { none, prefixSums, pyramid, direct };  // direct: points are single texels, no scan

// The grids of K directions over the image, all levels. Those of a batch of directions are consecutive in one image; batches follow one
// another, as in section 6 of the paper.
struct FarFieldGrid {
    std::vector<shared::Direction> directions;
    uint32_t interval = 0;  // B0, px; longer than asked for only if the cells of one direction do not fit
    uint32_t half = 0;      // directions that are scanned: K / 2 and their opposites at the same time, or K
    uint32_t batch = 0;     // of them, at most so many at a time
    uint32_t levels = 1;
    VkFormat format = VK_FORMAT_R32_UINT;  // of a cell: a point or a prefix sum
    uint32_t rows = 0;                     // of kCellsWide cells; the longest batch's
    uint64_t bytes = 0;                    // of it
    uint32_t lines = 0, intervals = 0;     // maximum over directions
};
// Sets from, step, slope and perRise of the directions, for points on the image plane of a view. slope: s where no view ray is too flat.
void setAxes(FarFieldGrid& grid, const shared::View& view, float slope);
// size: px, guard band included; interval, lineStep: px.
struct FarFieldLimits {
    uint64_t bytes = 1u << 28;  // of the cells
    uint32_t rows = 4096;       // of an image on the device
};
FarFieldGrid farFieldGrid(
    shared::uvec2 size, uint32_t directions, uint32_t interval, uint32_t lineStep, Averaging averaging, const FarFieldLimits& limits = {});

}  // namespace obscura::ao
