// Cells and bricks. The centre of cell c is at c * cellSize metres on each axis, as in OpenVDB: a floor at height 0 runs through the middle
// of a layer of cells and not between two layers. A set cell touches a surface. A brick is 8 x 8 x 8 cells in 64 bytes, with the bit order
// of an OpenVDB mask leaf, which is also what the GPU reads.
// Levels: a cell of level k + 1 is the union of eight cells of level k, 2 c to 2 c + 1 on each axis, and is set if any of them is. Level 0
// has the cells of cellSize metres.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace obscura::voxel {

inline constexpr int kBrickSide = 8;
inline constexpr int kMostCell = 1 << 23;  // cells are in [-kMostCell, kMostCell): a brick's coordinates then pack into 63 bits

struct Brick {
    std::array<uint64_t, 8> words{};  // word x, bit 8 y + z

    bool test(int x, int y, int z) const { return words[size_t(x)] >> (8 * y + z) & 1; }
    void set(int x, int y, int z) { words[size_t(x)] |= uint64_t(1) << (8 * y + z); }
    bool empty() const;
    uint32_t count() const;
    Brick& operator|=(const Brick& other);
    bool operator==(const Brick&) const = default;
};
static_assert(sizeof(Brick) == 64);

inline glm::ivec3 brickOf(const glm::ivec3& cell) { return {cell.x >> 3, cell.y >> 3, cell.z >> 3}; }
// The cell or brick of a level that contains a cell or brick of level 0.
inline glm::ivec3 atLevel(const glm::ivec3& place, uint32_t level) { return {place.x >> level, place.y >> level, place.z >> level}; }
// Sorts places and removes duplicates; toNextLevel() first replaces them by those of the next level.
void sortUnique(std::vector<glm::ivec3>& places);
void toNextLevel(std::vector<glm::ivec3>& places);
// Sets the cells of a brick of the next level that contain the set cells of its octant; each coordinate of `octant` is 0 or 1.
void addOctant(const Brick& fine, const glm::ivec3& octant, Brick& coarse);

// A hash map of bricks by place (cell coordinates / 8), in the order of insertion. clear() keeps the memory, so that a set that is refilled
// every frame does not allocate.
class BrickSet {
public:
    Brick& at(const glm::ivec3& place);  // inserted empty if missing; valid until the next at()
    const Brick* find(const glm::ivec3& place) const;
    void set(const glm::ivec3& cell);
    bool test(const glm::ivec3& cell) const;
    void merge(const BrickSet& other);
    void nextLevel(BrickSet& next) const;  // `next`: cleared, then the next level of this set
    void clear();
    void swap(BrickSet& other);

    size_t size() const { return m_bricks.size(); }
    uint64_t cells() const;
    uint64_t bytes() const;
    glm::ivec3 place(size_t i) const;
    const Brick& operator[](size_t i) const { return m_bricks[i]; }

private:
    uint32_t slotOf(uint64_t key) const;  // of the key, or the free slot to insert it into
    void grow();
    std::vector<uint64_t> m_keys;
    std::vector<Brick> m_bricks;
    std::vector<uint32_t> m_slots;  // index + 1, 0 where free; a power of two, at most half full
};

}  // namespace obscura::voxel
