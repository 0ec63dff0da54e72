#include "voxel/nano_grid.h"

#include <algorithm>
#include <cstring>

#include "voxel/sparse.h"

#define PNANOVDB_C
#include <nanovdb/PNanoVDB.h>

namespace obscura::voxel {
namespace {

// Of nodes of a mask grid, bytes.
const pnanovdb_grid_type_constants_t& kSizes = pnanovdb_grid_type_constants[PNANOVDB_GRID_TYPE_MASK];

}  // namespace

// Starts from OpenVDB's own conversion of a grid with one cell, which makes the headers, then empties it.
NanoGrid::NanoGrid() {
    BrickSet one;
    one.set(glm::ivec3(0));
    Sparse sparse;
    sparse.add(one);
    m_words = sparse.nano();
    m_used = bytes();
    const pnanovdb_buf_t buffer = pnanovdb_make_buf(m_words.data(), m_words.size());
    const pnanovdb_tree_handle_t tree = pnanovdb_grid_get_tree(buffer, {pnanovdb_address_null()});
    const pnanovdb_root_handle_t root = pnanovdb_tree_get_root(buffer, tree);
    const pnanovdb_coord_t origin{0, 0, 0};
    const pnanovdb_root_tile_handle_t tile = pnanovdb_root_find_tile(PNANOVDB_GRID_TYPE_MASK, buffer, root, &origin);
    m_upper = pnanovdb_root_get_child(PNANOVDB_GRID_TYPE_MASK, buffer, root, tile).address.byte_offset;
    put(glm::ivec3(0), Brick());
}

// Address of a node's child; 0: none.
uint64_t NanoGrid::child(uint64_t node, uint32_t index, uint32_t mask, uint32_t table) const {
    if (!(m_words[(node + mask) / 4 + index / 32] >> (index % 32) & 1u)) return 0;
    int64_t offset = 0;
    std::memcpy(&offset, &m_words[(node + table) / 4 + uint64_t(index) * kSizes.table_stride / 4], sizeof(offset));
    return node + uint64_t(offset);
}

// `child` 0: removes it.
void NanoGrid::link(uint64_t node, uint32_t index, uint32_t mask, uint32_t table, uint64_t child) {
    const uint32_t bit = 1u << (index % 32);
    const uint64_t at = node + mask + index / 32 * 4;
    const uint32_t word = child ? m_words[at / 4] | bit : m_words[at / 4] & ~bit;
    write(at, &word, sizeof(word));
    const int64_t offset = child ? int64_t(child - node) : 0;
    write(node + table + uint64_t(index) * kSizes.table_stride, &offset, sizeof(offset));
}

uint64_t NanoGrid::append(uint64_t size) {
    const uint64_t at = m_used;
    m_used += size;
    if (m_used > bytes()) {
        m_words.resize(std::max(2 * m_words.size(), size_t(m_used / 4)), 0u);
        m_grown = true;
    }
    return at;
}

void NanoGrid::write(uint64_t address, const void* data, uint64_t size) {
    std::memcpy(&m_words[address / 4], data, size);
    m_changed.push_back({address, size});
}

bool NanoGrid::put(const glm::ivec3& place, const Brick& brick) {
    const pnanovdb_coord_t cell{place.x * kBrickSide, place.y * kBrickSide, place.z * kBrickSide};
    const uint32_t inUpper = pnanovdb_upper_coord_to_offset(&cell), inLower = pnanovdb_lower_coord_to_offset(&cell);
    uint64_t lower = child(m_upper, inUpper, PNANOVDB_UPPER_OFF_CHILD_MASK, kSizes.upper_off_table);
    uint64_t leaf = lower ? child(lower, inLower, PNANOVDB_LOWER_OFF_CHILD_MASK, kSizes.lower_off_table) : 0;
    if (brick.empty()) {
        if (!leaf) return false;
        link(lower, inLower, PNANOVDB_LOWER_OFF_CHILD_MASK, kSizes.lower_off_table, 0);
        m_free.push_back(leaf);
        return true;
    }
    if (leaf && std::memcmp(&m_words[(leaf + PNANOVDB_LEAF_OFF_VALUE_MASK) / 4], brick.words.data(), sizeof(Brick)) == 0) return false;
    if (!lower) {
        lower = append(kSizes.lower_size);
        link(m_upper, inUpper, PNANOVDB_UPPER_OFF_CHILD_MASK, kSizes.upper_off_table, lower);
        m_changed.push_back({lower, kSizes.lower_size});  // zeros
    }
    if (!leaf) {
        if (m_free.empty()) {
            leaf = append(kSizes.leaf_size);
        } else {
            leaf = m_free.back();
            m_free.pop_back();
        }
        link(lower, inLower, PNANOVDB_LOWER_OFF_CHILD_MASK, kSizes.lower_off_table, leaf);
    }
    write(leaf + PNANOVDB_LEAF_OFF_VALUE_MASK, brick.words.data(), sizeof(Brick));
    return true;
}

std::vector<NanoGrid::Range> NanoGrid::takeChanged() {
    std::vector<Range> taken;
    if (m_grown) {
        taken.push_back({0, bytes()});
    } else {
        std::sort(m_changed.begin(), m_changed.end(), [](const Range& a, const Range& b) { return a.offset < b.offset; });
        for (const Range& range : m_changed) {
            const uint64_t end = taken.empty() ? 0 : taken.back().offset + taken.back().bytes;
            if (!taken.empty() && range.offset <= end) taken.back().bytes = std::max(end, range.offset + range.bytes) - taken.back().offset;
            else taken.push_back(range);
        }
    }
    m_changed.clear();
    m_grown = false;
    return taken;
}

}  // namespace obscura::voxel
