// A NanoVDB grid of type mask that is edited brick by brick, for a copy on the GPU that receives only what changed. All cells lie in
// [0, 4096)^3, below one upper node; lower nodes and leaves are appended where they are first needed, and leaves that become empty are
// used again. Bounding boxes, counts and checksums of the grid are not maintained: a lookup needs none of them.
#pragma once

#include <span>

#include "voxel/bricks.h"

namespace obscura::voxel {

class NanoGrid {
public:
    NanoGrid();

    // Replaces a brick, of a place in [0, 512)^3. False if this changes nothing.
    bool put(const glm::ivec3& place, const Brick& brick);

    uint64_t bytes() const { return m_words.size() * sizeof(uint32_t); }  // of the buffer, spare room included; grows by doubling
    std::span<const uint32_t> words() const { return m_words; }

    struct Range {
        uint64_t offset = 0, bytes = 0;  // multiples of 4
    };
    // What changed since the last call, ascending; everything after the buffer has grown.
    std::vector<Range> takeChanged();

private:
    uint64_t child(uint64_t node, uint32_t index, uint32_t mask, uint32_t table) const;
    void link(uint64_t node, uint32_t index, uint32_t mask, uint32_t table, uint64_t child);
    uint64_t append(uint64_t bytes);
    void write(uint64_t address, const void* data, uint64_t bytes);
    std::vector<uint32_t> m_words;
    uint64_t m_used = 0, m_upper = 0;  // bytes
    std::vector<uint64_t> m_free;      // leaves
    std::vector<Range> m_changed;
    bool m_grown = true;
};

}  // namespace obscura::voxel
