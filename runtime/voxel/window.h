// One level's window on the GPU: a dense cube of bricks, addressed toroidally. A brick's address is its place modulo the cube's side, so
// moving the window writes only the slabs that enter. The windows of all levels are centred on the eye [Losasso and Hoppe 2004, clipmaps].
#pragma once

#include <functional>

#include "voxel/bricks.h"

namespace obscura::voxel {

class Window {
public:
    explicit Window(uint32_t cells);  // per side: 64, 128, 256 or 512

    // Computes the cells of one brick of the world.
    using Compose = std::function<void(const glm::ivec3& place, Brick& out)>;
    // Makes `origin` the lowest brick, then composes the bricks that entered and those in `changed`, which may have duplicates and places
    // outside. `all`: composes every brick. Bricks with equal contents do not count as changed.
    void update(const glm::ivec3& origin, std::span<const glm::ivec3> changed, bool all, const Compose& compose);

    void place(const glm::ivec3& origin) { m_origin = origin; }  // moves without composing

    uint32_t cells() const { return m_side * kBrickSide; }
    glm::ivec3 origin() const { return m_origin; }  // in bricks
    bool holds(const glm::ivec3& place) const;
    uint32_t addressOf(const glm::ivec3& place) const;  // (x * side + y) * side + z, with the place modulo side
    const Brick& operator[](uint32_t address) const { return m_bricks[address]; }

    // Addresses of the bricks that changed since the last call, ascending. `all`: of every brick that is not empty.
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

// The brick of level 0 that the windows are centred on: the one that contains the eye.
glm::ivec3 centreBrick(double cellSize, const glm::vec3& eye);
// The lowest brick of a level's window. Level k then holds all cells less than cells / 2 - 8 cells of that level from the lowest corner of
// the centre brick, along each axis; level 0 those less than cells / 2.
glm::ivec3 windowOrigin(uint32_t cells, uint32_t level, const glm::ivec3& centre);

}  // namespace obscura::voxel
