// The part of the world that the GPU holds: a cube of bricks, dense, anchored to the world. A brick stands at the address its
// place has modulo the cube's side, so a move leaves what stays where it is and writes only the slabs that entered.
#pragma once

#include <functional>

#include "voxel/bricks.h"

namespace obscura::voxel {

class Window {
public:
    explicit Window(uint32_t cells);  // a side: 64, 128, 256 or 512

    // What the world holds in one brick.
    using Compose = std::function<void(const glm::ivec3& place, Brick& out)>;
    // Moves to where `origin` is the lowest brick, then fills what entered and what `changed` names (duplicates and places
    // outside are fine). `all`: everything is composed anew. Bricks that come out as they were are not touched.
    void update(const glm::ivec3& origin, std::span<const glm::ivec3> changed, bool all, const Compose& compose);

    void place(const glm::ivec3& origin) { m_origin = origin; }  // and nothing else

    uint32_t cells() const { return m_side * kBrickSide; }
    glm::ivec3 origin() const { return m_origin; }  // in bricks
    bool holds(const glm::ivec3& place) const;
    uint32_t addressOf(const glm::ivec3& place) const;  // index of the brick, (x * side + y) * side + z of its place modulo side
    const Brick& operator[](uint32_t address) const { return m_bricks[address]; }

    // Addresses of the bricks that are others than when this was last called, in order. `all`: of every brick that is not empty.
    std::vector<uint32_t> takeChanged(bool all);

private:
    void compose(const glm::ivec3& place, const Compose& compose);
    uint32_t m_side;
    bool m_placed = false;
    glm::ivec3 m_origin{0};
    std::vector<Brick> m_bricks;
    std::vector<bool> m_isChanged;
    std::vector<uint32_t> m_changed;
};

// The lowest brick of a window around the eye: in the middle of a world that fits, else around the eye but not beyond the world.
glm::ivec3 windowOrigin(uint32_t cells, double cellSize, const glm::vec3& worldMin, const glm::vec3& worldMax, const glm::vec3& eye);

}  // namespace obscura::voxel
