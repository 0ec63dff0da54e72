// Triangles to cells, conservatively: a cell is set exactly when triangle and cube touch, by the separating axes of a
// triangle and a box [Akenine-Möller 2001], walked in columns along the triangle's dominant axis [Schwarz and Seidel 2010].
// Or thinly: only as many cells as it takes that no path over cell faces crosses the surface (their 6-separating shell).
#pragma once

#include <functional>
#include <span>

#include "voxel/bricks.h"

namespace obscura::voxel {

struct Triangles {                          // world space, metres
    std::span<const glm::vec3> positions;
    std::span<const uint32_t> indices;      // three a triangle, each < positions.size()
};

enum class Shell : uint8_t { conservative, thin };

struct RasterOptions {
    Shell shell = Shell::conservative;
    size_t mostBricks = size_t(1) << 22;    // 256 MiB of bits; more is refused
    std::function<void(float)> progress;    // 0 to 1, now and then, from the calling thread
};

struct RasterReport {
    uint64_t triangles = 0;                 // rasterised; those without area count, as the segment or point they are
    uint64_t notFinite = 0;                 // left out: a vertex is NaN or infinite
    uint64_t tooFar = 0;                    // left out: beyond kMostCell cells of the origin
    RasterReport& operator+=(const RasterReport& other);
};

// Adds the triangles' cells to `into`; many triangles are dealt to all of TBB's threads. Throws scene::Error, before much
// memory is taken, when the surface needs more bricks than may be; the line says which cell size would do.
RasterReport rasterise(const Triangles& triangles, double cellSize, BrickSet& into, const RasterOptions& options = {});

// Square metres of the triangles whose vertices are finite and have no coordinate beyond `within` metres.
double area(const Triangles& triangles, double within);
// What a surface of this area needs at least about.
double bricksOf(double area, double cellSize);

}  // namespace obscura::voxel
