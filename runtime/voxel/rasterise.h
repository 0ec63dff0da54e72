// Triangles to cells. Conservative: a cell is set exactly if triangle and cube touch, by the separating axes of a triangle and a box
// [Akenine-Möller 2001], in columns along the triangle's dominant axis [Schwarz and Seidel 2010]. Thin: only enough cells that no
// path over cell faces crosses the surface (their 6-separating shell).
#pragma once

#include <functional>
#include <span>

#include "voxel/bricks.h"

namespace obscura::voxel {

struct Triangles {  // world space, metres
    std::span<const glm::vec3> positions;
    std::span<const uint32_t> indices;  // three per triangle, each < positions.size()
};

enum class Shell : uint8_t { conservative, thin };

struct RasterOptions {
    Shell shell = Shell::conservative;
    size_t mostBricks = size_t(1) << 22;  // limit; 2^22 bricks are 256 MiB of bits
    std::function<void(float)> progress;  // 0 to 1, every 2^20 triangles, from the calling thread
};

struct RasterReport {
    uint64_t triangles = 0;  // rasterised; degenerate ones included, as segments or points
    uint64_t notFinite = 0;  // skipped: a vertex is NaN or infinite
    uint64_t tooFar = 0;     // skipped: more than kMostCell cells from the origin
    RasterReport& operator+=(const RasterReport& other);
};

// Adds the triangles' cells to `into`; more than 2048 triangles run on all TBB threads. Throws scene::Error if the surface needs more than
// mostBricks bricks, before it allocates much memory; the message suggests a cell size.
RasterReport rasterise(const Triangles& triangles, double cellSize, BrickSet& into, const RasterOptions& options = {});

// Square metres of the triangles whose vertices are finite and have no coordinate beyond `within` metres.
double area(const Triangles& triangles, double within);
// Estimated number of bricks of a surface of this area.
double bricksOf(double area, double cellSize);

}  // namespace obscura::voxel
