#include "voxel/bricks.h"

#include <algorithm>
#include <bit>
#include <tuple>

namespace obscura::voxel {
namespace {

constexpr int kBias = kMostCell / kBrickSide;  // makes places positive: 21 bits per axis

uint64_t keyOf(const glm::ivec3& place) {
    return uint64_t(place.x + kBias) << 42 | uint64_t(place.y + kBias) << 21 | uint64_t(place.z + kBias);
}

}  // namespace

bool Brick::empty() const {
    uint64_t any = 0;
    for (const uint64_t word : words) any |= word;
    return any == 0;
}

uint32_t Brick::count() const {
    uint32_t sum = 0;
    for (const uint64_t word : words) sum += uint32_t(std::popcount(word));
    return sum;
}

Brick& Brick::operator|=(const Brick& other) {
    for (size_t i = 0; i < words.size(); ++i) words[i] |= other.words[i];
    return *this;
}

void sortUnique(std::vector<glm::ivec3>& places) {
    std::sort(places.begin(), places.end(),
        [](const glm::ivec3& a, const glm::ivec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
    places.erase(std::unique(places.begin(), places.end()), places.end());
}

void toNextLevel(std::vector<glm::ivec3>& places) {
    for (glm::ivec3& place : places) place = atLevel(place, 1);
    sortUnique(places);
}

void addOctant(const Brick& fine, const glm::ivec3& octant, Brick& coarse) {
    for (int x = 0; x < kBrickSide / 2; ++x) {
        uint64_t pairs = fine.words[size_t(2 * x)] | fine.words[size_t(2 * x + 1)];
        pairs |= pairs >> kBrickSide;                          // neighbours along y, in the even bytes
        pairs = (pairs | pairs >> 1) & 0x0055005500550055ull;  // and along z, in the even bits
        pairs = (pairs | pairs >> 1) & 0x0033003300330033ull;  // which become the lowest four bits of a byte
        pairs = (pairs | pairs >> 2) & 0x000f000f000f000full;
        uint64_t rows = 0;
        for (int y = 0; y < kBrickSide / 2; ++y) rows |= (pairs >> 16 * y & 0xf) << kBrickSide * y;
        coarse.words[size_t(4 * octant.x + x)] |= rows << (kBrickSide * 4 * octant.y + 4 * octant.z);
    }
}

uint32_t BrickSet::slotOf(uint64_t key) const {
    const uint32_t mask = uint32_t(m_slots.size()) - 1;
    uint32_t slot = uint32_t(key * 0x9e3779b97f4a7c15ull >> 32) & mask;
    while (m_slots[slot] != 0 && m_keys[m_slots[slot] - 1] != key) slot = (slot + 1) & mask;
    return slot;
}

void BrickSet::grow() {
    m_slots.assign(m_slots.empty() ? 64 : 2 * m_slots.size(), 0);
    for (size_t i = 0; i < m_keys.size(); ++i) m_slots[slotOf(m_keys[i])] = uint32_t(i) + 1;
}

Brick& BrickSet::at(const glm::ivec3& place) {
    if (2 * (m_bricks.size() + 1) > m_slots.size()) grow();
    const uint64_t key = keyOf(place);
    uint32_t& slot = m_slots[slotOf(key)];
    if (slot == 0) {
        m_keys.push_back(key);
        m_bricks.emplace_back();
        slot = uint32_t(m_bricks.size());
    }
    return m_bricks[slot - 1];
}

const Brick* BrickSet::find(const glm::ivec3& place) const {
    if (m_slots.empty()) return nullptr;
    const uint32_t index = m_slots[slotOf(keyOf(place))];
    return index ? &m_bricks[index - 1] : nullptr;
}

void BrickSet::set(const glm::ivec3& cell) { at(brickOf(cell)).set(cell.x & 7, cell.y & 7, cell.z & 7); }

bool BrickSet::test(const glm::ivec3& cell) const {
    const Brick* brick = find(brickOf(cell));
    return brick && brick->test(cell.x & 7, cell.y & 7, cell.z & 7);
}

void BrickSet::merge(const BrickSet& other) {
    for (size_t i = 0; i < other.size(); ++i) at(other.place(i)) |= other[i];
}

void BrickSet::nextLevel(BrickSet& next) const {
    next.clear();
    for (size_t i = 0; i < size(); ++i) addOctant(m_bricks[i], place(i) & 1, next.at(atLevel(place(i), 1)));
}

void BrickSet::clear() {
    // With few bricks in a large table, only their slots are cleared.
    if (m_slots.size() > 8 * m_keys.size()) {
        for (size_t i = m_keys.size(); i-- > 0;) m_slots[slotOf(m_keys[i])] = 0;
    } else {
        std::fill(m_slots.begin(), m_slots.end(), 0u);
    }
    m_keys.clear();
    m_bricks.clear();
}

void BrickSet::swap(BrickSet& other) {
    m_keys.swap(other.m_keys);
    m_bricks.swap(other.m_bricks);
    m_slots.swap(other.m_slots);
}

uint64_t BrickSet::cells() const {
    uint64_t sum = 0;
    for (const Brick& brick : m_bricks) sum += brick.count();
    return sum;
}

uint64_t BrickSet::bytes() const {
    return m_keys.capacity() * sizeof(uint64_t) + m_bricks.capacity() * sizeof(Brick) + m_slots.capacity() * sizeof(uint32_t);
}

glm::ivec3 BrickSet::place(size_t i) const {
    const uint64_t key = m_keys[i], mask = (uint64_t(1) << 21) - 1;
    return glm::ivec3(int(key >> 42 & mask), int(key >> 21 & mask), int(key & mask)) - kBias;
}

}  // namespace obscura::voxel
