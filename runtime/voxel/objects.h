// What moves: every part of the world that is animated or was moved holds its own bricks, redone when it has moved and left
// alone when it has not.
#pragma once

#include <functional>
#include <map>
#include <memory>

#include "voxel/parts.h"

namespace obscura::voxel {

class Objects {
public:
    using Complain = std::function<void(const std::string&)>;

    // The instance's parts that are to be here this time; call for each instance between begin() and end().
    void begin() { ++m_round; }
    void add(const scene::Instance& instance, std::span<const Part> parts);
    // Redoes what moved, in parallel, and drops what was not added; appends the bricks that either changed. A part that cannot be
    // rasterised is left out, with a line.
    void end(float time, double cellSize, const Picked& picked, Shell shell, std::vector<glm::ivec3>& changed, const Complain& complain);
    void clear() { m_objects.clear(); }

    // Adds what the objects have in a brick.
    void compose(const glm::ivec3& place, Brick& out) const;
    size_t count() const { return m_objects.size(); }
    size_t redone() const { return m_redone; }     // by the last end()
    uint64_t cells() const;
    uint64_t bytes() const;

private:
    struct Object {
        const scene::Instance* instance = nullptr;  // valid between begin() and end()
        std::shared_ptr<const scene::Model> model;
        Part part;
        uint64_t round = 0;
        bool fresh = true;
        glm::mat4 matrix{0.0f};                     // that `bricks` were made with
        float time = 0.0f;
        BrickSet bricks, before;
        glm::ivec3 low{0}, high{-1};                // of `bricks`
        std::string complaint;
        bool complained = false;
    };
    bool moved(Object& object, const scene::Pose& pose, float time) const;
    static void redo(Object& object, const scene::Pose& pose, double cellSize, const Picked& picked, Shell shell, Posed& scratch);

    std::map<std::pair<uint32_t, int>, Object> m_objects;  // by instance and node
    uint64_t m_round = 0;
    size_t m_redone = 0;
};

}  // namespace obscura::voxel
