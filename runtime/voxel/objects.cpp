#include "voxel/objects.h"

#include <algorithm>

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "scene/gltf/gltf.h"

namespace obscura::voxel {

void Objects::add(const scene::Instance& instance, std::span<const Part> parts) {
    for (const Part& part : parts) {
        Object& object = m_objects[{instance.id, part.node}];
        if (object.model != instance.model) object.fresh = true;
        object.model = instance.model;
        object.instance = &instance;
        object.part = part;
        object.round = m_round;
    }
}

// Whether the object's bricks must be made again: it has moved, or entered or left the grid's box.
bool Objects::moved(Object& object, const scene::Pose& pose, float time, const Grid& grid) {
    const scene::Instance& instance = *object.instance;
    if (object.fresh) object.bounds = boundsOf(*instance.model, object.part, grid.picked);
    const scene::Bounds box = boundsOf(instance, object.part, pose, object.bounds);
    // Comparisons with NaN are false: such an object is inside, and its finite triangles count.
    const glm::dvec3 low(box.min), high(box.max);
    const bool outside = box.empty || glm::any(glm::lessThan(high, grid.low)) || glm::any(glm::greaterThan(low, grid.high));
    const bool crossed = outside != object.outside;
    object.outside = outside;
    const glm::mat4 matrix = instance.placement * pose.world[size_t(object.part.node)];
    const float own = object.part.deforms ? time + instance.timeOffset : 0.0f;
    const bool moved = object.fresh || matrix != object.matrix || own != object.time;
    object.matrix = matrix;
    object.time = own;
    object.fresh = false;
    return crossed || (moved && !outside);
}

void Objects::rasteriseObject(Object& object, const scene::Pose& posed, const Grid& grid, Posed& scratch) {
    object.bricks.resize(grid.levels);
    BrickSet& bricks = object.bricks[0];
    object.before.swap(bricks);
    bricks.clear();
    object.error.clear();
    if (!object.outside) {
        pose(*object.instance, object.part, posed, grid.picked, scratch);
        RasterOptions options;
        options.shell = grid.shell;
        options.mostBricks = size_t(1) << 18;  // 16 MiB
        try {
            const RasterReport report = rasterise(scratch.triangles(), grid.cellSize, bricks, options);
            if (report.notFinite + report.tooFar > 0)
                object.error = fmt::format("{} of {} triangles are skipped: not finite, or more than 2^23 cells from the origin",
                    report.notFinite + report.tooFar, scratch.indices.size() / 3);
        } catch (const scene::Error& failure) {
            bricks.clear();
            object.error = failure.what();
        }
    }
    for (size_t k = 1; k < object.bricks.size(); ++k) object.bricks[k - 1].nextLevel(object.bricks[k]);
    object.low = glm::ivec3(kMostCell);
    object.high = glm::ivec3(-kMostCell);
    for (size_t i = 0; i < bricks.size(); ++i) {
        object.low = glm::min(object.low, bricks.place(i));
        object.high = glm::max(object.high, bricks.place(i));
    }
}

void Objects::end(float time, const Grid& grid, std::vector<glm::ivec3>& changed, const Log& log) {
    const auto note = [&](const BrickSet& bricks) {
        for (size_t i = 0; i < bricks.size(); ++i) changed.push_back(bricks.place(i));
    };
    std::map<uint32_t, scene::Pose> poses;
    for (auto it = m_objects.begin(); it != m_objects.end();) {
        if (it->second.round == m_round) {
            poses.try_emplace(it->first.first);
            ++it;
            continue;
        }
        if (!it->second.bricks.empty()) note(it->second.bricks[0]);
        it = m_objects.erase(it);
    }
    std::vector<std::pair<const scene::Instance*, scene::Pose*>> wanted;
    for (auto& [key, object] : m_objects)
        if (wanted.empty() || wanted.back().first != object.instance) wanted.push_back({object.instance, &poses[key.first]});
    tbb::parallel_for(size_t(0), wanted.size(), [&](size_t i) {
        const scene::Instance& instance = *wanted[i].first;
        *wanted[i].second = scene::evaluate(*instance.model, instance.animation, time + instance.timeOffset);
    });
    std::vector<std::pair<Object*, const scene::Pose*>> jobs;
    for (auto& [key, object] : m_objects)
        if (moved(object, poses[key.first], time, grid)) jobs.push_back({&object, &poses[key.first]});
    tbb::enumerable_thread_specific<Posed> scratch;
    tbb::parallel_for(size_t(0), jobs.size(), [&](size_t i) { rasteriseObject(*jobs[i].first, *jobs[i].second, grid, scratch.local()); });
    for (const auto& [object, posed] : jobs) {
        note(object->before);
        note(object->bricks[0]);
        if (!object->error.empty() && !object->logged) {
            log(fmt::format("{}, node {}: {}", object->model->name, object->part.node, object->error));
            object->logged = true;
        }
    }
    m_redone = jobs.size();
}

void Objects::compose(const glm::ivec3& place, uint32_t level, Brick& out) const {
    for (const auto& [key, object] : m_objects) {
        if (object.bricks.empty() || glm::any(glm::lessThan(place, atLevel(object.low, level))) ||
            glm::any(glm::greaterThan(place, atLevel(object.high, level))))
            continue;
        if (const Brick* brick = object.bricks[level].find(place)) out |= *brick;
    }
}

uint64_t Objects::cells() const {
    uint64_t sum = 0;
    for (const auto& [key, object] : m_objects)
        if (!object.bricks.empty()) sum += object.bricks[0].cells();
    return sum;
}

uint64_t Objects::bytes() const {
    uint64_t sum = 0;
    for (const auto& [key, object] : m_objects) {
        sum += object.before.bytes();
        for (const BrickSet& bricks : object.bricks) sum += bricks.bytes();
    }
    return sum;
}

}  // namespace obscura::voxel
