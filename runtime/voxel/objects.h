// Dynamic objects: parts that are animated or whose instance was moved. Each has its own bricks, rasterised again when it has moved.
#pragma once

#include <functional>
#include <map>
#include <memory>

#include "voxel/parts.h"

namespace obscura::voxel {

class Objects {
public:
    using Log = std::function<void(const std::string&)>;

    // Between begin() and end(), add() the dynamic parts of each instance.
    void begin() { ++m_round; }
    void add(const scene::Instance& instance, std::span<const Part> parts);
    // Rasterises moved parts again, in parallel, and removes parts that were not added. Appends the places of all bricks that this changed.
    // A part that cannot be rasterised is skipped, with one log line.
    void end(float time, double cellSize, const Picked& picked, Shell shell, std::vector<glm::ivec3>& changed, const Log& log);
    void clear() { m_objects.clear(); }

    // Adds the objects' cells of one brick to `out`.
    void compose(const glm::ivec3& place, Brick& out) const;
    size_t count() const { return m_objects.size(); }
    size_t redone() const { return m_redone; }  // parts rasterised by the last end()
    uint64_t cells() const;
    uint64_t bytes() const;

private:
    struct Object {
        const scene::Instance* instance = nullptr;  // valid between begin() and end()
        std::shared_ptr<const scene::Model> model;
        Part part;
        uint64_t round = 0;
        bool fresh = true;
        glm::mat4 matrix{0.0f};  // of `bricks`
        float time = 0.0f;
        BrickSet bricks, before;
        glm::ivec3 low{0}, high{-1};  // of `bricks`
        std::string error;
        bool logged = false;
    };
    bool moved(Object& object, const scene::Pose& pose, float time) const;
    static void rasteriseObject(
        Object& object, const scene::Pose& pose, double cellSize, const Picked& picked, Shell shell, Posed& scratch);

    std::map<std::pair<uint32_t, int>, Object> m_objects;  // by instance and node
    uint64_t m_round = 0;
    size_t m_redone = 0;
};

}  // namespace obscura::voxel
