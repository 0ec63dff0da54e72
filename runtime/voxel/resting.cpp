#include "voxel/resting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "scene/gltf/gltf.h"
#include "scene/hash.h"

namespace obscura::voxel {
namespace {

// Cache version: raise it when the same triangles give other bits.
constexpr uint32_t kVersion = 3;
constexpr double kFineWindow = 18.0;  // metres, largest side of the finest window
constexpr double kSmallestCell = 1e-4;
constexpr size_t kMergedPerCall = size_t(1) << 13;  // bricks: a few milliseconds
constexpr size_t kBuiltTogether = size_t(1) << 18;  // triangles, of instances that are built in one go

struct Cancelled {};

bool finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

// Calls visit(posed) for the instance's parts; `resting`: only for those that do not move.
template <class Visit>
void forEachPart(const scene::Instance& instance, float time, const Picked& picked, bool resting, Visit&& visit) {
    Posed posed;
    const scene::Pose shape = scene::evaluate(*instance.model, instance.animation, time + instance.timeOffset);
    for (const Part& part : partsOf(instance, picked)) {
        if (resting && part.moves) continue;
        pose(instance, part, shape, picked, posed);
        visit(posed);
    }
}

// Bricks [first, last) of a set.
BrickSet range(const BrickSet& bricks, size_t first, size_t last) {
    BrickSet result;
    for (size_t i = first; i < last; ++i) result.at(bricks.place(i)) = bricks[i];
    return result;
}

}  // namespace

bool Resting::Member::matches(const scene::Instance& other) const {
    return instance.model == other.model && instance.placement == other.placement && instance.animation == other.animation &&
           instance.root == other.root;
}

Resting::Resting(Options options) : m_options(std::move(options)) {}

Resting::~Resting() { m_cancel = true; }

bool Resting::isNewWorld(const scene::World& world) const {
    if (m_cellSize == 0.0) return true;
    bool any = false;
    for (const scene::Instance& instance : world.instances()) {
        if (!instance.model) continue;
        const auto known = m_known.find(instance.id);
        if (known != m_known.end() && known->second == instance.model) return false;
        any = true;
    }
    return any;
}

// Forgets everything and chooses the cell size.
void Resting::restart(const scene::World& world, float time) {
    m_cancel = true;
    m_builder.wait();
    m_cancel = false;
    m_builds.clear();
    m_queue.clear();
    m_merging.clear();
    m_members.clear();
    m_dynamic.clear();
    m_levels.clear();
    m_levels.resize(m_options.levels);
    m_facts = {};
    m_allTriangles = 0;
    m_doneTriangles = 0;
    m_cellSize = m_options.cellSize;
    if (m_cellSize > 0.0) return;

    scene::Bounds bounds;
    double surface = 0.0;
    for (const bool resting : {true, false}) {
        if (!bounds.empty) break;  // moving parts count only in a world without others
        for (const scene::Instance& instance : world.instances())
            if (instance.model)
                forEachPart(instance, time, m_options.picked, resting, [&](const Posed& posed) {
                    for (const glm::vec3& p : posed.positions)
                        if (finite(p)) bounds.add(p);
                    if (resting) surface += area(posed.triangles(), std::numeric_limits<double>::max());
                });
    }
    const glm::dvec3 size = bounds.empty ? glm::dvec3(1.0) : glm::dvec3(bounds.max) - glm::dvec3(bounds.min);
    // One brick at either end is reserved: origins snap to bricks.
    m_cellSize = std::clamp(std::max({size.x, size.y, size.z}) / double(m_options.cells - 2 * kBrickSide), kSmallestCell,
        kFineWindow / double(m_options.cells));
    const double affordable = m_cellSize * std::sqrt(bricksOf(surface, m_cellSize) / (0.5 * double(m_options.mostBricks)));
    const glm::dvec3 far = bounds.empty ? glm::dvec3(0.0) : glm::max(glm::abs(glm::dvec3(bounds.min)), glm::abs(glm::dvec3(bounds.max)));
    const double countable = 1.01 * std::max({far.x, far.y, far.z}) / double(kMostCell);
    if (const double least = std::max(affordable, countable); least > m_cellSize) {
        m_options.say(fmt::format("voxels: the world is too large for cells of {:.3g} m; using {:.3g} m", m_cellSize, least));
        m_cellSize = least;
    }
}

// Removes a member. The bricks that it shares with others are composed again from theirs.
void Resting::drop(uint32_t id, std::vector<glm::ivec3>& changed) {
    const auto gone = m_members.find(id);
    std::vector<glm::ivec3> places;
    places.reserve(gone->second.merged);
    for (size_t i = 0; i < gone->second.merged; ++i) places.push_back(gone->second.bricks.place(i));
    m_members.erase(gone);
    std::erase(m_queue, id);
    std::erase(m_merging, id);
    if (places.empty()) return;
    glm::ivec3 low = places[0], high = places[0];
    for (const glm::ivec3& place : places) low = glm::min(low, place), high = glm::max(high, place);
    std::vector<const Member*> near;
    for (const auto& [other, member] : m_members)
        if (member.merged > 0 && glm::all(glm::lessThanEqual(low, member.high)) && glm::all(glm::lessThanEqual(member.low, high)))
            near.push_back(&member);
    for (const glm::ivec3& place : places) {
        Brick brick;
        for (const Member* member : near)
            if (const Brick* own = member->bricks.find(place)) brick |= *own;
        m_levels[0].put(place, brick);
    }
    changed.insert(changed.end(), places.begin(), places.end());
    for (size_t k = 1; k < m_levels.size(); ++k) {
        toNextLevel(places);
        for (const glm::ivec3& place : places) {
            Brick brick;
            for (int i = 0; i < 8; ++i) {
                const glm::ivec3 octant(i & 1, i >> 1 & 1, i >> 2);
                Brick fine;
                if (m_levels[k - 1].find(2 * place + octant, fine)) addOctant(fine, octant, brick);
            }
            m_levels[k].put(place, brick);
        }
    }
}

void Resting::follow(const scene::World& world, std::vector<glm::ivec3>& changed) {
    std::map<uint32_t, std::shared_ptr<const scene::Model>> now;
    for (const scene::Instance& instance : world.instances()) {
        if (!instance.model) continue;
        now[instance.id] = instance.model;
        const auto known = m_known.find(instance.id);
        if (known != m_known.end() && known->second != instance.model) m_dynamic.erase(instance.id);
        const auto member = m_members.find(instance.id);
        if (member != m_members.end()) {
            if (member->second.matches(instance)) continue;
            if (member->second.instance.model == instance.model) m_dynamic.insert(instance.id);
            drop(instance.id, changed);
        }
        if (m_dynamic.count(instance.id)) continue;
        Member& added = m_members[instance.id];
        added.instance = instance;
        for (const Part& part : partsOf(instance, m_options.picked))
            if (!part.moves) added.triangles += trianglesOf(*instance.model, part, m_options.picked);
        if (!m_options.bits || added.triangles == 0) {
            added.built = true;
            continue;
        }
        if (m_queue.empty() && m_builds.empty()) {
            m_begun = std::chrono::steady_clock::now();
            m_allTriangles = 0;
            m_doneTriangles = 0;
        }
        m_queue.push_back(instance.id);
        m_allTriangles += added.triangles;
    }
    std::vector<uint32_t> gone;
    for (const auto& [id, member] : m_members)
        if (!now.count(id)) gone.push_back(id);
    for (const uint32_t id : gone) drop(id, changed);
    std::erase_if(m_dynamic, [&](uint32_t id) { return !now.count(id); });
    m_known = std::move(now);
}

// On m_builder's thread.
void Resting::build(Build& build, float time, size_t mostBricks) {
    Posed all;
    forEachPart(build.instance, time, m_options.picked, true, [&](const Posed& posed) {
        const uint32_t first = uint32_t(all.positions.size());
        all.positions.insert(all.positions.end(), posed.positions.begin(), posed.positions.end());
        for (const uint32_t index : posed.indices) all.indices.push_back(first + index);
    });
    std::string key;
    std::filesystem::path file;
    if (!m_options.cache.empty() && build.triangles >= m_options.cachedTriangles) {
        scene::Hash hash;
        hash.add(all.positions.data(), all.positions.size() * sizeof(glm::vec3));
        hash.add(all.indices.data(), all.indices.size() * sizeof(uint32_t));
        key = "voxels-" + hash.add(kVersion).add(uint32_t(m_options.shell)).add(m_cellSize).hex();
        file = m_options.cache / (key + ".vdb");
    }
    std::error_code ignored;
    if (!file.empty() && std::filesystem::exists(file, ignored)) {
        try {
            build.bricks = Sparse::load(file, key).bricksOfAll();
            build.fromCache = true;
            return;
        } catch (const scene::Error& broken) {
            build.lines.push_back(fmt::format("voxels: {}; it is built again", broken.what()));
        }
    }
    RasterOptions raster;
    raster.shell = m_options.shell;
    raster.mostBricks = mostBricks;
    const uint64_t before = m_doneTriangles;
    raster.progress = [&](float part) {
        if (m_cancel) throw Cancelled();
        m_doneTriangles = before + uint64_t(double(part) * double(build.triangles));
    };
    const RasterReport report = rasterise(all.triangles(), m_cellSize, build.bricks, raster);
    if (report.notFinite)
        build.lines.push_back(fmt::format("voxels: {} triangles with a vertex that is not finite are skipped", report.notFinite));
    if (report.tooFar)
        build.lines.push_back(
            fmt::format("voxels: {} triangles beyond {:.3g} m from the origin are skipped", report.tooFar, m_cellSize * kMostCell));
    if (file.empty()) return;
    try {
        std::filesystem::create_directories(m_options.cache, ignored);
        Sparse sparse;
        sparse.add(build.bricks);
        sparse.save(file, key, m_cellSize);
    } catch (const scene::Error& unwritable) {
        build.lines.push_back(fmt::format("voxels: {}; continuing without a cache", unwritable.what()));
    }
}

void Resting::startBuild(float time) {
    size_t triangles = 0, bricks = 0;
    for (const auto& [id, member] : m_members) bricks += member.bricks.size();
    while (!m_queue.empty() && triangles < kBuiltTogether) {
        const Member& member = m_members.at(m_queue.front());
        m_builds.push_back({m_queue.front(), member.instance, member.triangles, {}, false, {}, {}});
        triangles += member.triangles;
        m_queue.pop_front();
    }
    m_builder.post([this, time, left = m_options.mostBricks - std::min(m_options.mostBricks, bricks)]() mutable {
        for (Build& job : m_builds) {
            try {
                const uint64_t before = m_doneTriangles;
                build(job, time, left);
                m_doneTriangles = before + job.triangles;
                left -= std::min(left, job.bricks.size());
            } catch (const Cancelled&) {
                return;
            } catch (const std::exception& error) {
                job.bricks.clear();
                job.refusal = error.what();
            }
        }
    });
}

// Requires that m_builder is done.
void Resting::collectBuilds() {
    for (Build& build : m_builds) {
        for (const std::string& line : build.lines) m_options.say(line);
        if (!build.refusal.empty() && m_refused++ == 0) m_refusal = build.refusal;
        const auto found = m_members.find(build.id);
        // Dropped, or replaced and queued again, while it was built.
        if (found == m_members.end() || found->second.built || !found->second.matches(build.instance)) continue;
        Member& member = found->second;
        ++(build.fromCache ? m_facts.fromCache : m_facts.rasterised);
        member.built = true;
        member.bricks.swap(build.bricks);
        member.low = glm::ivec3(kMostCell);
        member.high = glm::ivec3(-kMostCell);
        for (size_t i = 0; i < member.bricks.size(); ++i) {
            member.low = glm::min(member.low, member.bricks.place(i));
            member.high = glm::max(member.high, member.bricks.place(i));
        }
        std::erase(m_queue, build.id);
        m_merging.push_back(build.id);
    }
    m_builds.clear();
    if (m_queue.empty() && m_refused > 0) {
        m_options.say(m_refused == 1 ? m_refusal : fmt::format("{} ({} objects are skipped)", m_refusal, m_refused));
        m_refused = 0;
    }
}

// Merges at most `most` bricks. True if there are more.
bool Resting::merge(size_t most, std::vector<glm::ivec3>& changed) {
    while (!m_merging.empty() && most > 0) {
        Member& member = m_members.at(m_merging.front());
        const size_t last = std::min(member.bricks.size(), member.merged + most);
        BrickSet set = range(member.bricks, member.merged, last), next;
        for (size_t i = 0; i < set.size(); ++i) changed.push_back(set.place(i));
        for (size_t k = 0; k < m_levels.size(); ++k) {
            m_levels[k].add(set);
            set.nextLevel(next);
            set.swap(next);
        }
        most -= last - member.merged;
        member.merged = last;
        if (last == member.bricks.size()) m_merging.pop_front();
        if (m_merging.empty()) count();
    }
    return !m_merging.empty();
}

void Resting::report() {
    const bool busy = !m_queue.empty() || !m_builds.empty();
    if (m_options.progress)
        *m_options.progress = busy && m_allTriangles > 0 ? std::min(0.999f, float(double(m_doneTriangles) / double(m_allTriangles))) : 1.0f;
}

bool Resting::update(const scene::World& world, float time, bool wait, std::vector<glm::ivec3>& changed) {
    const bool isNew = isNewWorld(world);
    if (isNew) restart(world, time);
    follow(world, changed);
    for (;;) {
        const bool idle = m_builder.done();
        if (idle && !m_builds.empty()) {
            collectBuilds();
            m_facts.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - m_begun).count();
        }
        if (idle && !m_queue.empty()) startBuild(time);
        const bool more = merge(wait ? std::numeric_limits<size_t>::max() : kMergedPerCall, changed);
        report();
        if (!wait || (!more && m_builds.empty())) return isNew;
        m_builder.done(std::chrono::milliseconds(50));
    }
}

void Resting::count() {
    m_facts.bytes = 0;
    for (const Sparse& level : m_levels) m_facts.bytes += level.bytes();
    for (const auto& [id, member] : m_members) m_facts.bytes += member.bricks.bytes();
}

RestingFacts Resting::facts() const {
    RestingFacts facts = m_facts;
    if (!m_levels.empty()) {
        facts.cells = m_levels[0].cells();
        facts.bricks = m_levels[0].bricks();
    }
    for (const auto& [id, member] : m_members) facts.triangles += member.triangles;
    return facts;
}

}  // namespace obscura::voxel
