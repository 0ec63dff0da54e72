// Dynamic objects: parts that are animated or whose instance was moved. Each has its own bricks at every level, rasterised again when it
// has moved. One that is outside of every window has none.
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
    struct Grid {
        double cellSize = 0.0;  // metres, of level 0
        uint32_t levels = 1;
        glm::dvec3 low{0.0}, high{0.0};  // metres; parts outside of this box are skipped
        Picked picked;
        Shell shell = Shell::conservative;
    };
    // Rasterises moved parts again, in parallel, and removes parts that were not added. Appends the places of level 0 of all bricks that
    // this changed. A part that cannot be rasterised is skipped, with one log line.
    void end(float time, const Grid& grid, std::vector<glm::ivec3>& changed, const Log& log);
    void clear() { m_objects.clear(); }

    // Adds the objects' cells of one brick of a level to `out`.
    void compose(const glm::ivec3& place, uint32_t level, Brick& out) const;
    size_t count() const { return m_objects.size(); }
    size_t redone() const { return m_redone; }  // parts rasterised by the last end()
    uint64_t cells() const;                     // of level 0
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
        scene::Bounds bounds;          // of the part's vertices before skinning, morph targets included; the node's space
        bool outside = false;          // of the grid's box
        std::vector<BrickSet> bricks;  // by level
        BrickSet before;               // of level 0, in the last frame
        glm::ivec3 low{0}, high{-1};   // of bricks[0]
        std::string error;
        bool logged = false;
    };
    static bool moved(Object& object, const scene::Pose& pose, float time, const Grid& grid);
    static void rasteriseObject(Object& object, const scene::Pose& pose, const Grid& grid, Posed& scratch);

    std::map<std::pair<uint32_t, int>, Object> m_objects;  // by instance and node
    uint64_t m_round = 0;
    size_t m_redone = 0;
};

}  // namespace obscura::voxel
