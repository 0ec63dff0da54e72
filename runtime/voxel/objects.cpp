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

bool Objects::moved(Object& object, const scene::Pose& pose, float time) const {
    const glm::mat4 matrix = object.instance->placement * pose.world[size_t(object.part.node)];
    const float own = object.part.deforms ? time + object.instance->timeOffset : 0.0f;
    const bool moved = object.fresh || matrix != object.matrix || own != object.time;
    object.matrix = matrix;
    object.time = own;
    object.fresh = false;
    return moved;
}

void Objects::rasteriseObject(
    Object& object, const scene::Pose& posed, double cellSize, const Picked& picked, Shell shell, Posed& scratch) {
    object.before.swap(object.bricks);
    object.bricks.clear();
    pose(*object.instance, object.part, posed, picked, scratch);
    RasterOptions options;
    options.shell = shell;
    options.mostBricks = size_t(1) << 18;  // 16 MiB
    try {
        const RasterReport report = rasterise(scratch.triangles(), cellSize, object.bricks, options);
        if (report.notFinite + report.tooFar > 0)
            object.error = fmt::format("{} of {} triangles are skipped: not finite, or more than 2^23 cells from the origin",
                report.notFinite + report.tooFar, scratch.indices.size() / 3);
    } catch (const scene::Error& failure) {
        object.bricks.clear();
        object.error = failure.what();
    }
    object.low = glm::ivec3(kMostCell);
    object.high = glm::ivec3(-kMostCell);
    for (size_t i = 0; i < object.bricks.size(); ++i) {
        object.low = glm::min(object.low, object.bricks.place(i));
        object.high = glm::max(object.high, object.bricks.place(i));
    }
}

void Objects::end(float time, double cellSize, const Picked& picked, Shell shell, std::vector<glm::ivec3>& changed, const Log& log) {
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
        note(it->second.bricks);
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
        if (moved(object, poses[key.first], time)) jobs.push_back({&object, &poses[key.first]});
    tbb::enumerable_thread_specific<Posed> scratch;
    tbb::parallel_for(size_t(0), jobs.size(),
        [&](size_t i) { rasteriseObject(*jobs[i].first, *jobs[i].second, cellSize, picked, shell, scratch.local()); });
    for (const auto& [object, posed] : jobs) {
        note(object->before);
        note(object->bricks);
        if (!object->error.empty() && !object->logged) {
            log(fmt::format("{}, node {}: {}", object->model->name, object->part.node, object->error));
            object->logged = true;
        }
    }
    m_redone = jobs.size();
}

void Objects::compose(const glm::ivec3& place, Brick& out) const {
    for (const auto& [key, object] : m_objects) {
        if (glm::any(glm::lessThan(place, object.low)) || glm::any(glm::greaterThan(place, object.high))) continue;
        if (const Brick* brick = object.bricks.find(place)) out |= *brick;
    }
}

uint64_t Objects::cells() const {
    uint64_t sum = 0;
    for (const auto& [key, object] : m_objects) sum += object.bricks.cells();
    return sum;
}

uint64_t Objects::bytes() const {
    uint64_t sum = 0;
    for (const auto& [key, object] : m_objects) sum += object.bricks.bytes() + object.before.bytes();
    return sum;
}

}  // namespace obscura::voxel
