// The voxel rasteriser against an independent test: clipping each triangle by the six planes of a cell.
#include <algorithm>
#include <cmath>
#include <limits>

#include "shapes.h"

namespace obscura::test {
namespace {

// Whether the triangle intersects the cell, enlarged by `margin` on each side.
bool cutOverlaps(const glm::dvec3* triangle, const glm::ivec3& cell, double margin) {
    std::vector<glm::dvec3> polygon(triangle, triangle + 3);
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {1.0, -1.0}) {
            const double plane = side > 0.0 ? double(cell[axis]) + 1.0 + margin : -(double(cell[axis]) - margin);
            std::vector<glm::dvec3> kept;
            for (size_t i = 0; i < polygon.size(); ++i) {
                const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
                const double da = plane - side * a[axis], db = plane - side * b[axis];
                if (da >= 0.0) kept.push_back(a);
                if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) kept.push_back(a + (b - a) * (da / (da - db)));
            }
            polygon = std::move(kept);
            if (polygon.empty()) return false;
        }
    return true;
}

// Tests every cell of the bounds and one around them; cells within the margin may be set or not.
void expectExact(const Soup& soup, double cellSize) {
    for (size_t t = 0; t < soup.indices.size(); t += 3) {
        Soup one;
        one.add(soup.positions[soup.indices[t]], soup.positions[soup.indices[t + 1]], soup.positions[soup.indices[t + 2]]);
        voxel::BrickSet bricks;
        voxel::rasterise(one.triangles(), cellSize, bricks);
        glm::dvec3 p[3];
        glm::dvec3 low(1e9), high(-1e9);
        for (int i = 0; i < 3; ++i) {
            p[i] = glm::dvec3(one.positions[size_t(i)]) * (1.0 / cellSize) + 0.5;
            low = glm::min(low, p[i]);
            high = glm::max(high, p[i]);
        }
        uint64_t seen = 0;
        glm::ivec3 cell;
        for (cell.x = int(std::floor(low.x)) - 1; cell.x <= int(std::floor(high.x)) + 1; ++cell.x)
            for (cell.y = int(std::floor(low.y)) - 1; cell.y <= int(std::floor(high.y)) + 1; ++cell.y)
                for (cell.z = int(std::floor(low.z)) - 1; cell.z <= int(std::floor(high.z)) + 1; ++cell.z) {
                    const bool set = bricks.test(cell);
                    seen += set;
                    if (set)
                        ASSERT_TRUE(cutOverlaps(p, cell, 1e-5))
                            << "triangle " << t / 3 << ", cell " << cell.x << ' ' << cell.y << ' ' << cell.z << " is set but not touched";
                    else
                        ASSERT_FALSE(cutOverlaps(p, cell, -1e-5))
                            << "triangle " << t / 3 << ", cell " << cell.x << ' ' << cell.y << ' ' << cell.z << " is missing";
                }
        ASSERT_EQ(bricks.cells(), seen) << "cells far from the triangle";
    }
}

TEST(Rasterise, randomTrianglesFillTouchedCells) {
    expectExact(randomSoup(600, 4.0f, 0.3f, 1), 0.1);      // a few cells
    expectExact(randomSoup(150, 20.0f, 3.0f, 2), 0.1);     // tens of cells
    expectExact(randomSoup(150, 2000.0f, 1.0f, 3), 0.05);  // far from the origin
}

TEST(Rasterise, trianglesOfAnyOrientationFillTouchedCells) {
    Soup soup;
    for (int axis = 0; axis < 3; ++axis) {  // across an axis, within a cell and on the cells' boundary
        glm::vec3 a(0.13f), b(0.13f), c(0.13f);
        a[axis] = b[axis] = c[axis] = 0.35f;
        b[(axis + 1) % 3] += 1.7f;
        c[(axis + 2) % 3] += 1.1f;
        soup.add(a, b, c);
        soup.add(a - glm::vec3(0.35f), b - glm::vec3(0.35f), c - glm::vec3(0.35f));
    }
    soup.add({0.05f, 0.05f, 0.05f}, {2.05f, 2.05f, 2.05f}, {2.05f, 2.05f, 0.05f});       // on a diagonal plane
    soup.add({0.01f, 0.02f, 0.03f}, {3.01f, 2.02f, 1.03f}, {3.01f, 2.02f, 1.0300002f});  // a sliver
    soup.add({0.01f, 0.02f, 0.03f}, {1.01f, 3.02f, 2.03f}, {0.51f, 1.52f, 1.03f});       // three collinear points
    soup.add({0.01f, 0.02f, 0.03f}, {0.01f, 0.02f, 0.03f}, {0.9f, -1.2f, 2.03f});        // an edge of length 0
    soup.add({0.31f, 0.02f, 0.03f}, {0.31f, 0.02f, 0.03f}, {0.31f, 0.02f, 0.03f});       // a point
    expectExact(soup, 0.1);
}

TEST(Rasterise, bothCellsOfATouchedBoundaryAreSet) {
    Soup soup;
    soup.add({-0.25f, 0.5f, -0.25f}, {0.25f, 0.5f, -0.25f}, {-0.25f, 0.5f, 0.25f});
    voxel::BrickSet bricks;
    voxel::rasterise(soup.triangles(), 1.0, bricks);
    EXPECT_EQ(cellsOf(bricks), (Cells{{0, 0, 0}, {0, 1, 0}}));
}

// The thin shell of a closed surface is watertight for paths across cell faces, for any size of triangle.
TEST(Rasterise, thinShellsAreWatertight) {
    constexpr float kPi = 3.14159265f;
    for (const int segments : {5, 14, 60}) {
        Soup ball;
        const auto point = [&](int i, int k) {
            const float up = kPi * float(i) / float(segments), around = 2.0f * kPi * float(k) / float(segments);
            return glm::vec3(0.03f, -0.21f, 0.11f) +
                   1.3f * glm::vec3(std::sin(up) * std::cos(around), std::cos(up), std::sin(up) * std::sin(around));
        };
        for (int i = 0; i < segments; ++i)
            for (int k = 0; k < segments; ++k) {
                ball.add(point(i, k), point(i + 1, k), point(i + 1, k + 1));
                ball.add(point(i, k), point(i + 1, k + 1), point(i, k + 1));
            }
        voxel::BrickSet thin, thick;
        voxel::rasterise(ball.triangles(), 0.1, thick);
        voxel::rasterise(ball.triangles(), 0.1, thin, {.shell = voxel::Shell::thin});
        const Cells few = cellsOf(thin), many = cellsOf(thick);
        EXPECT_TRUE(std::includes(many.begin(), many.end(), few.begin(), few.end()));
        EXPECT_LT(double(few.size()), 0.65 * double(many.size()));
        Cells reached{{-20, -20, -20}};
        std::vector<std::array<int, 3>> open(reached.begin(), reached.end());
        while (!open.empty()) {
            const std::array<int, 3> at = open.back();
            open.pop_back();
            for (int step = 0; step < 6; ++step) {
                std::array<int, 3> next = at;
                next[size_t(step / 2)] += step % 2 ? 1 : -1;
                if (std::abs(next[size_t(step / 2)]) > 20 || few.count(next) || !reached.insert(next).second) continue;
                open.push_back(next);
            }
        }
        EXPECT_FALSE(reached.count({0, -2, 1})) << segments << " segments: the flood fill reached the middle";
        EXPECT_GT(reached.size(), 40000u);
    }
}

TEST(Rasterise, anyThreadCountGivesTheSameCells) {
    const Soup soup = randomSoup(50000, 10.0f, 0.5f);
    voxel::BrickSet together, alone;
    EXPECT_EQ(voxel::rasterise(soup.triangles(), 0.1, together).triangles, 50000u);
    for (size_t first = 0; first < soup.indices.size(); first += 3000)
        voxel::rasterise(
            {soup.positions, std::span(soup.indices).subspan(first, std::min<size_t>(3000, soup.indices.size() - first))}, 0.1, alone);
    EXPECT_EQ(together.cells(), alone.cells());
    EXPECT_EQ(cellsOf(together), cellsOf(alone));
}

TEST(Rasterise, invalidVerticesAreCountedAndSkipped) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    Soup soup;
    soup.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    soup.add({0, nan, 0}, {1, 0, 0}, {0, 1, 0});
    soup.add({0, 0, 0}, {infinite, 0, 0}, {0, 1, 0});
    soup.add({1e30f, 0, 0}, {1, 0, 0}, {0, 1, 0});
    voxel::BrickSet bricks, first;
    const voxel::RasterReport report = voxel::rasterise(soup.triangles(), 0.1, bricks, {.mostBricks = 1000});
    EXPECT_EQ(report.triangles, 1u);
    EXPECT_EQ(report.notFinite, 2u);
    EXPECT_EQ(report.tooFar, 1u);
    voxel::rasterise({soup.positions, std::span(soup.indices).first(3)}, 0.1, first);
    EXPECT_EQ(cellsOf(bricks), cellsOf(first));
}

// The memory limit holds for any tessellation, and the error names a cell size that fits.
TEST(Rasterise, surfaceBeyondTheMemoryLimitIsRefused) {
    Soup wide;
    wide.add({-5e5f, 0, -5e5f}, {5e5f, 0, -5e5f}, {0, 0, 5e5f});
    Soup folded = randomSoup(20000, 500.0f, 50.0f);
    for (const Soup* soup : {&wide, &folded}) {
        voxel::BrickSet bricks;
        try {
            voxel::rasterise(soup->triangles(), 0.1, bricks, {.mostBricks = 5000});
            ADD_FAILURE() << "not refused";
        } catch (const scene::Error& error) {
            const std::string what = error.what();
            EXPECT_NE(what.find("use cells of"), std::string::npos) << what;
            EXPECT_EQ(what.find('\n'), std::string::npos) << what;
        }
        EXPECT_LE(bricks.size(), 10001u);
    }
}

}  // namespace
}  // namespace obscura::test
