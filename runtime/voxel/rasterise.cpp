#include "voxel/rasterise.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include "scene/gltf/gltf.h"

namespace obscura::voxel {
namespace {

// Cells. Widens the tests, so that rounding does not lose cells that are merely touched.
constexpr double kTouch = 1e-7;

// Sets cells and remembers the last brick: neighbours are mostly in the same one. The writers of a call count new bricks together and stop
// at the limit.
class CellWriter {
public:
    CellWriter(BrickSet& set, std::atomic<size_t>& taken, size_t limit) : m_set(set), m_taken(taken), m_limit(limit) {}
    void set(const glm::ivec3& cell) {
        const glm::ivec3 place = brickOf(cell);
        if (m_brick == nullptr || place != m_place) {
            const size_t before = m_set.size();
            m_brick = &m_set.at(place);
            m_place = place;
            m_full = m_full || m_taken.fetch_add(m_set.size() - before, std::memory_order_relaxed) > m_limit;
        }
        m_brick->set(cell.x & 7, cell.y & 7, cell.z & 7);
    }
    bool full() const { return m_full; }

private:
    BrickSet& m_set;
    std::atomic<size_t>& m_taken;
    size_t m_limit;
    glm::ivec3 m_place{0};
    Brick* m_brick = nullptr;
    bool m_full = false;
};

struct Range {
    int from, to;  // both included
};

// The cross product of an edge with a box axis is a direction in the plane of the other two axes, s and t. Triangle and cell
// overlap along it while the cell's lower corner, a s + b t, lies in [low, high].
struct Edge {
    double a, b, low, high;
    bool overlaps(double s, double t) const {
        const double at = a * s + b * t;
        return at >= low && at <= high;
    }
    // Narrows a range of t to those that overlap at s.
    void narrow(double s, Range& t) const {
        if (b == 0.0) {
            if (!overlaps(s, 0.0)) t.to = t.from - 1;
            return;
        }
        const double inverse = 1.0 / b, one = (low - a * s) * inverse, two = (high - a * s) * inverse;
        t = {int(std::max(double(t.from), std::ceil(std::min(one, two)))), int(std::min(double(t.to), std::floor(std::max(one, two))))};
    }
};

inline Edge edge(const glm::dvec3* p, int i, int s, int t, bool thin) {
    const glm::dvec3 &from = p[i], &to = p[(i + 1) % 3], &other = p[(i + 2) % 3];
    Edge e{from[t] - to[t], to[s] - from[s], 0.0, 0.0};
    const double along = e.a * from[s] + e.b * from[t], across = e.a * other[s] + e.b * other[t];
    // Extent of a cell from its centre along the direction; of the thin shell, extent of the cell's axes only.
    const double sum = std::abs(e.a) + std::abs(e.b), middle = 0.5 * (e.a + e.b);
    const double reach = 0.5 * (thin ? std::max(std::abs(e.a), std::abs(e.b)) : sum) + kTouch * sum;
    e.low = std::min(along, across) - middle - reach;
    e.high = std::max(along, across) - middle + reach;
    return e;
}

// `p` in cells, counted from the lowest corner of cell 0. Columns run along w, the normal's largest axis, so that the plane crosses few
// cells of each. A triangle too thin for a reliable normal is decided by the edge tests alone, with rows along its longest side.
void drawTriangle(const glm::dvec3* p, bool thin, CellWriter& writer) {
    glm::ivec3 low, high;
    for (int k = 0; k < 3; ++k) {
        low[k] = int(std::floor(std::min({p[0][k], p[1][k], p[2][k]}) - kTouch));
        high[k] = int(std::floor(std::max({p[0][k], p[1][k], p[2][k]}) + kTouch));
    }
    const glm::ivec3 span = high - low;
    glm::ivec3 cell;
    if (!thin && (span.x == 0) + (span.y == 0) + (span.z == 0) >= 2) {  // one row of cells: a triangle touches them all
        for (cell.x = low.x; cell.x <= high.x; ++cell.x)
            for (cell.y = low.y; cell.y <= high.y; ++cell.y)
                for (cell.z = low.z; cell.z <= high.z && !writer.full(); ++cell.z) writer.set(cell);
        return;
    }
    const glm::dvec3 q[3] = {p[0] - glm::dvec3(low), p[1] - glm::dvec3(low), p[2] - glm::dvec3(low)};
    if (!thin && (span.x == 0 || span.y == 0 || span.z == 0)) {  // one layer of cells: a test in two dimensions
        const int w = span.z == 0 ? 2 : span.x == 0 ? 0 : 1, u = (w + 1) % 3, v = (w + 2) % 3;
        const Edge edges[3] = {edge(q, 0, u, v, false), edge(q, 1, u, v, false), edge(q, 2, u, v, false)};
        cell[w] = low[w];
        for (int i = 0; i <= span[u] && !writer.full(); ++i) {
            Range across{0, span[v]};
            for (const Edge& e : edges) e.narrow(i, across);
            cell[u] = low[u] + i;
            for (int j = across.from; j <= across.to; ++j) cell[v] = low[v] + j, writer.set(cell);
        }
        return;
    }
    const glm::dvec3 n = glm::cross(q[1] - q[0], q[2] - q[0]), size = glm::abs(n);
    const double longest = double(std::max({span.x, span.y, span.z}));
    const bool flat = std::max({size.x, size.y, size.z}) > 1e-7 * longest * longest;
    const int w = flat ? (size.z >= size.x && size.z >= size.y ? 2
                             : size.x >= size.y                ? 0
                                                               : 1)
                       : ((span.z >= span.x && span.z >= span.y ? 2
                              : span.x >= span.y                ? 0
                                                                : 1) +
                             1) %
                             3;
    const int u = (w + 2) % 3, v = (w + 1) % 3;
    Edge uv[3], uw[3], vw[3];
    for (int i = 0; i < 3; ++i) uv[i] = edge(q, i, u, v, thin), uw[i] = edge(q, i, u, w, thin), vw[i] = edge(q, i, v, w, thin);

    // Height of the plane at the middle of a column, and the largest distance from it to the lower side of an overlapping cell.
    const double slopeU = flat ? -n[u] / n[w] : 0.0, slopeV = flat ? -n[v] / n[w] : 0.0;
    const double reach = 0.5 + 0.5 * (thin ? 0.0 : std::abs(slopeU) + std::abs(slopeV)) + kTouch;
    for (int i = 0; i <= span[u] && !writer.full(); ++i) {
        Range across{0, span[v]};
        for (const Edge& e : uv) e.narrow(i, across);
        cell[u] = low[u] + i;
        for (int j = across.from; j <= across.to; ++j) {
            cell[v] = low[v] + j;
            Range up{0, span[w]};
            if (flat) {
                const double height = q[0][w] + slopeU * (i + 0.5 - q[0][u]) + slopeV * (j + 0.5 - q[0][v]) - 0.5;
                up = {int(std::max(0.0, std::ceil(height - reach))), int(std::min(double(span[w]), std::floor(height + reach)))};
            } else {
                for (const Edge& e : uw) e.narrow(i, up);
            }
            for (int k = up.from; k <= up.to; ++k) {
                if (!(uw[0].overlaps(i, k) && uw[1].overlaps(i, k) && uw[2].overlaps(i, k))) continue;
                if (!(vw[0].overlaps(j, k) && vw[1].overlaps(j, k) && vw[2].overlaps(j, k))) continue;
                cell[w] = low[w] + k;
                writer.set(cell);
            }
        }
    }
}

bool finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

RasterReport drawRange(const Triangles& triangles, double inverse, bool thin, size_t begin, size_t end, CellWriter writer) {
    RasterReport report;
    constexpr double kMost = double(kMostCell - 1);
    for (size_t i = begin; i < end && !writer.full(); ++i) {
        const uint32_t* index = &triangles.indices[3 * i];
        const glm::vec3 &a = triangles.positions[index[0]], &b = triangles.positions[index[1]], &c = triangles.positions[index[2]];
        if (!finite(a) || !finite(b) || !finite(c)) {
            ++report.notFinite;
            continue;
        }
        const glm::dvec3 p[3] = {glm::dvec3(a) * inverse + 0.5, glm::dvec3(b) * inverse + 0.5, glm::dvec3(c) * inverse + 0.5};
        const glm::dvec3 most = glm::max(glm::max(glm::abs(p[0]), glm::abs(p[1])), glm::abs(p[2]));
        if (std::max({most.x, most.y, most.z}) >= kMost) {
            ++report.tooFar;
            continue;
        }
        drawTriangle(p, thin, writer);
        ++report.triangles;
    }
    return report;
}

[[noreturn]] void refuse(double bricks, double cellSize, size_t most) {
    throw scene::Error(
        fmt::format("voxels: the surfaces need about {:.3g} bricks of 8x8x8 cells at {:.3g} m per cell; the limit is {}: "
                    "use cells of {:.2g} m or more",
            bricks, cellSize, most, 1.1 * cellSize * std::sqrt(bricks / double(most))));
}

}  // namespace

RasterReport& RasterReport::operator+=(const RasterReport& other) {
    triangles += other.triangles;
    notFinite += other.notFinite;
    tooFar += other.tooFar;
    return *this;
}

double area(const Triangles& triangles, double within) {
    const auto sum = [&](const tbb::blocked_range<size_t>& range, double twice) {
        for (size_t i = 3 * range.begin(); i < 3 * range.end(); i += 3) {
            const glm::dvec3 a(triangles.positions[triangles.indices[i]]);
            const glm::dvec3 b(triangles.positions[triangles.indices[i + 1]]), c(triangles.positions[triangles.indices[i + 2]]);
            const glm::dvec3 most = glm::max(glm::max(glm::abs(a), glm::abs(b)), glm::abs(c));
            const double own = glm::length(glm::cross(b - a, c - a));
            if (most.x < within && most.y < within && most.z < within && own > 0.0) twice += own;
        }
        return twice;
    };
    // Bit-exact for any number of threads: the cell size, and so the names of cached files, depend on it.
    const tbb::blocked_range<size_t> all(0, triangles.indices.size() / 3, 8192);
    return 0.5 * tbb::parallel_deterministic_reduce(all, 0.0, sum, std::plus<double>());
}

// A plane through a grid of bricks crosses 1 to 2 bricks per brick-face area, 1.5 on average.
double bricksOf(double area, double cellSize) {
    const double side = kBrickSide * cellSize;
    return 1.5 * area / (side * side);
}

RasterReport rasterise(const Triangles& triangles, double cellSize, BrickSet& into, const RasterOptions& options) {
    const size_t count = triangles.indices.size() / 3;
    const double inverse = 1.0 / cellSize;
    const bool thin = options.shell == Shell::thin;
    constexpr size_t kBlock = 2048, kRound = size_t(1) << 20;
    // Coincident surfaces count twice in the area, so the estimate alone refuses only far above the limit.
    const double expected = bricksOf(area(triangles, cellSize * kMostCell), cellSize);
    if (expected > 16.0 * double(options.mostBricks)) refuse(expected, cellSize, options.mostBricks);
    const size_t limit = 2 * options.mostBricks;  // several threads can have the same brick
    std::atomic<size_t> taken{into.size()};
    RasterReport report;
    struct ThreadResult {
        BrickSet bricks;
        RasterReport report;
    };
    tbb::enumerable_thread_specific<ThreadResult> results;
    for (size_t first = 0; first < count; first += kRound) {
        if (options.progress) options.progress(float(first) / float(count));
        if (count <= kBlock) {
            report += drawRange(triangles, inverse, thin, 0, count, CellWriter(into, taken, limit));
        } else {
            tbb::parallel_for(
                tbb::blocked_range<size_t>(first, std::min(count, first + kRound), kBlock), [&](const tbb::blocked_range<size_t>& range) {
                    ThreadResult& own = results.local();
                    own.report += drawRange(triangles, inverse, thin, range.begin(), range.end(), CellWriter(own.bricks, taken, limit));
                });
            for (ThreadResult& result : results) {
                into.merge(result.bricks);
                result.bricks.clear();
            }
        }
        if (taken > limit || into.size() > options.mostBricks)
            refuse(std::max(expected, double(std::max(into.size(), options.mostBricks + 1))), cellSize, options.mostBricks);
        taken = into.size();
    }
    for (const ThreadResult& result : results) report += result.report;
    if (options.progress) options.progress(1.0f);
    return report;
}

}  // namespace obscura::voxel
