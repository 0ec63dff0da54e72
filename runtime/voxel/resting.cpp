#include "voxel/resting.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "scene/gltf/gltf.h"
#include "scene/hash.h"

namespace obscura::voxel {
namespace {

// Cache version: raise it when the same triangles give other bits.
constexpr uint32_t kVersion = 2;
// Metres. At most 1/14 of the usual reach of 2 m: larger cells darken open places.
constexpr double kLargestCell = 0.14, kSmallestCell = 1e-4;
// An instance that is added later with fewer static triangles becomes an object instead of causing a rebuild.
constexpr size_t kRebuildTriangles = 4096;

bool finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

bool Resting::holds(const scene::World& world, const Picked& picked) {
    if (!m_built) return false;
    size_t found = 0;
    bool same = true;
    for (const scene::Instance& instance : world.instances()) {
        if (!instance.model) continue;
        const auto member = m_members.find(instance.id);
        if (member != m_members.end()) {
            ++found;
            if (member->second.matches(instance)) continue;
            if (member->second.model != instance.model) m_dynamic.clear();
            else m_dynamic.insert(instance.id);
            same = false;
        } else if (same && !m_dynamic.count(instance.id)) {
            size_t triangles = 0;
            for (const Part& part : partsOf(instance, picked))
                if (!part.moves) triangles += trianglesOf(*instance.model, part, picked);
            same = triangles < kRebuildTriangles;
        }
    }
    if (found != m_members.size()) m_dynamic.clear();
    return same && found == m_members.size();
}

void Resting::forEach(const scene::World& world, float time, const Picked& picked, bool resting, const Visit& visit) const {
    Posed posed;
    for (const scene::Instance& instance : world.instances()) {
        if (!instance.model || (resting && !m_members.count(instance.id))) continue;
        const scene::Pose shape = scene::evaluate(*instance.model, instance.animation, time + instance.timeOffset);
        for (const Part& part : partsOf(instance, picked)) {
            if (resting && part.moves) continue;
            pose(instance, part, shape, picked, posed);
            visit(posed);
        }
    }
}

// Sets bounds, cell size and triangle count, without rasterising. Returns the cache key.
std::string Resting::measure(const scene::World& world, float time, const Options& options) {
    scene::Hash hash;
    double surface = 0.0;
    const auto bound = [&](const Posed& posed) {
        for (const glm::vec3& p : posed.positions)
            if (finite(p)) m_bounds.add(p);
    };
    forEach(world, time, options.picked, true, [&](const Posed& posed) {
        hash.add(posed.positions.data(), posed.positions.size() * sizeof(glm::vec3));
        hash.add(posed.indices.data(), posed.indices.size() * sizeof(uint32_t));
        surface += area(posed.triangles(), std::numeric_limits<double>::max());
        m_facts.triangles += posed.indices.size() / 3;
        bound(posed);
    });
    if (m_bounds.empty) forEach(world, time, options.picked, false, bound);
    m_cellSize = options.cellSize;
    if (m_cellSize <= 0.0) {
        const glm::dvec3 size = m_bounds.empty ? glm::dvec3(1.0) : glm::dvec3(m_bounds.max) - glm::dvec3(m_bounds.min);
        // One brick at either end is reserved: the origin snaps to bricks.
        m_cellSize = std::clamp(std::max({size.x, size.y, size.z}) / double(options.cells - 2 * kBrickSide), kSmallestCell, kLargestCell);
        const double affordable = m_cellSize * std::sqrt(bricksOf(surface, m_cellSize) / (0.5 * double(options.mostBricks)));
        const glm::dvec3 far =
            m_bounds.empty ? glm::dvec3(0.0) : glm::max(glm::abs(glm::dvec3(m_bounds.min)), glm::abs(glm::dvec3(m_bounds.max)));
        const double countable = 1.01 * std::max({far.x, far.y, far.z}) / double(kMostCell);
        if (const double least = std::max(affordable, countable); least > m_cellSize) {
            options.say(fmt::format("voxels: the world is too large for cells of {:.3g} m; using {:.3g} m", m_cellSize, least));
            m_cellSize = least;
        }
    }
    return "voxels-" + hash.add(kVersion).add(uint32_t(options.shell)).add(m_cellSize).hex();
}

void Resting::rasteriseAll(const scene::World& world, float time, const Options& options) {
    BrickSet bricks;
    RasterReport report;
    RasterOptions raster;
    raster.shell = options.shell;
    raster.mostBricks = options.mostBricks;
    uint64_t done = 0;
    forEach(world, time, options.picked, true, [&](const Posed& posed) {
        const size_t count = posed.indices.size() / 3;
        raster.progress = [&](float part) {
            if (options.progress) *options.progress = float((double(done) + double(part) * double(count)) / double(m_facts.triangles));
        };
        report += rasterise(posed.triangles(), m_cellSize, bricks, raster);
        done += count;
    });
    if (report.notFinite) options.say(fmt::format("voxels: {} triangles with a vertex that is not finite are skipped", report.notFinite));
    if (report.tooFar)
        options.say(fmt::format("voxels: {} triangles beyond {:.3g} m from the origin are skipped", report.tooFar, m_cellSize * kMostCell));
    m_sparse.add(bricks);
}

void Resting::build(const scene::World& world, float time, const Options& options) {
    const auto begun = std::chrono::steady_clock::now();
    m_members.clear();
    for (const scene::Instance& instance : world.instances())
        if (instance.model && !m_dynamic.count(instance.id))
            m_members[instance.id] = {instance.model, instance.placement, instance.animation, instance.root};
    m_sparse = Sparse();
    m_bounds = {};
    m_facts = {};
    m_built = true;
    const auto finish = [&] {
        m_facts.cells = m_sparse.cells();
        m_facts.bricks = m_sparse.bricks();
        m_facts.bytes = m_sparse.bytes();
        m_facts.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
    };
    const std::string key = measure(world, time, options);
    if (!options.bits) return finish();
    const std::filesystem::path file = options.cache.empty() || m_facts.triangles == 0 ? "" : options.cache / (key + ".vdb");
    std::error_code ignored;
    if (!file.empty() && std::filesystem::exists(file, ignored)) {
        try {
            m_sparse = Sparse::load(file, key);
            m_facts.fromCache = true;
        } catch (const scene::Error& broken) {
            options.say(fmt::format("voxels: {}; it is built again", broken.what()));
        }
    }
    if (!m_facts.fromCache) {
        rasteriseAll(world, time, options);
        if (!file.empty()) {
            try {
                std::filesystem::create_directories(options.cache, ignored);
                m_sparse.save(file, key, m_cellSize);
            } catch (const scene::Error& unwritable) {
                options.say(fmt::format("voxels: {}; continuing without a cache", unwritable.what()));
            }
        }
    }
    finish();
}

}  // namespace obscura::voxel
