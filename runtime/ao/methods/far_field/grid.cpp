#include "ao/methods/far_field/grid.h"

#include <algorithm>
#include <cmath>

namespace obscura::ao {
namespace {

constexpr uint32_t kMostLevels = 7;

uint32_t roundUp(uint32_t value, uint32_t unit) { return (value + unit - 1) / unit * unit; }

FarFieldGrid gridOf(shared::uvec2 size, uint32_t directions, uint32_t interval, uint32_t lineStep, Averaging averaging) {
    FarFieldGrid grid;
    grid.interval = interval;
    const double longest = std::hypot(double(size.x), double(size.y)) / interval;
    while (grid.levels < kMostLevels && double(2u << grid.levels) <= longest) ++grid.levels;
    const uint32_t unit = 1u << (grid.levels - 1);
    for (uint32_t k = 0; k < directions; ++k) {
        const double angle = 6.283185307179586 * k / directions, c = std::cos(angle), s = std::sin(angle);
        const double along = std::abs(c) * size.x + std::abs(s) * size.y, across = std::abs(s) * size.x + std::abs(c) * size.y;
        shared::Direction d{};
        d.along = {float(c), float(s)};
        d.lines = std::max(roundUp(uint32_t(std::ceil(across / lineStep - 1e-6)), unit), 2 * unit);
        d.intervals = roundUp(uint32_t(std::ceil(along / interval - 1e-6)), unit);
        // Lines and steps that are parallel to pixels pass through their middles; on their edges, points would lie half a pixel aside.
        const auto centre = [&](double extent, double length, double first) {
            const double between = extent * 0.5 + first - length * 0.5, aside = std::abs(between - std::floor(between) - 0.5);
            const bool moved = (std::abs(c) < 1e-6 || std::abs(s) < 1e-6) && aside > 0.25;
            return float(length * 0.5) + (!moved ? 0.0f : 2 * k < directions ? 0.5f : -0.5f);
        };
        d.origin = {centre(along, double(d.intervals) * interval, 0.5), centre(across, double(d.lines) * lineStep, 0.5 * lineStep)};
        const uint64_t level0 = uint64_t(d.lines) * d.intervals;
        const uint32_t multiple = 1u << ((averaging == Averaging::pyramid ? 2 : 1) * grid.levels);
        const uint64_t total = averaging == Averaging::pyramid ? (4 * level0 + 2) / 3 : 2 * level0;
        d.total = uint32_t((total + multiple - 1) / multiple * multiple);
        grid.lines = std::max(grid.lines, d.lines);
        grid.intervals = std::max(grid.intervals, d.intervals);
        grid.directions.push_back(d);
    }
    grid.format = averaging == Averaging::prefixSums ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32_UINT;
    return grid;
}

// Sets half and batch, and what follows from them.
void divide(FarFieldGrid& grid, uint32_t half, uint32_t batch) {
    uint64_t most = 0;
    for (uint32_t first = 0; first < half; first += batch) {
        uint64_t cells = 0;
        for (uint32_t opposite = 0; opposite < grid.directions.size(); opposite += half)
            for (uint32_t k = first; k < std::min(first + batch, half); ++k) {
                shared::Direction& d = grid.directions[opposite + k];
                d.base = uint32_t(cells);
                cells += d.total;
            }
        most = std::max(most, cells);
    }
    grid.half = half;
    grid.batch = batch;
    grid.rows = uint32_t((most + shared::kCellsWide - 1) / shared::kCellsWide);
    grid.bytes = uint64_t(grid.rows) * shared::kCellsWide * (grid.format == VK_FORMAT_R32_UINT ? 4 : 16);
}

}  // namespace

void setAxes(FarFieldGrid& grid, const shared::View& view, float slope) {
    for (shared::Direction& d : grid.directions) {
        const shared::vec2 g{d.along.x * view.unproject.x, d.along.y * view.unproject.y};
        const float width = float(view.size.x), height = float(view.size.y);
        d.step = std::hypot(g.x, g.y);
        d.from =
            ((0.5f * width * view.unproject.x + view.unproject.z) * g.x + (0.5f * height * view.unproject.y + view.unproject.w) * g.y) /
            d.step;
        const float edge = std::abs(d.from) + 0.5f * d.step * (std::abs(d.along.x) * width + std::abs(d.along.y) * height),
                    most = view.orthographic > 0.5f ? std::abs(slope) : shared::kFlattest / edge;
        d.slope = std::clamp(slope, -most, most);
        d.perRise = 1.0f / (d.slope * d.step);
    }
}

FarFieldGrid farFieldGrid(
    shared::uvec2 size, uint32_t directions, uint32_t interval, uint32_t lineStep, Averaging averaging, const FarFieldLimits& limits) {
    const uint32_t half = directions % 2 == 0 ? directions / 2 : directions;
    for (;; ++interval) {
        FarFieldGrid grid = gridOf(size, directions, interval, lineStep, averaging);
        const auto fits = [&](uint32_t scanned, uint32_t batch) {
            divide(grid, scanned, batch);
            return averaging == Averaging::direct || (grid.bytes <= limits.bytes && grid.rows <= limits.rows);
        };
        for (uint32_t batches = 1; batches <= half; ++batches)
            if (fits(half, (half + batches - 1) / batches)) return grid;
        if (half < directions && fits(directions, 1)) return grid;
    }
}

}  // namespace obscura::ao
