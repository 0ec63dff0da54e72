#include "voxel/window.h"

#include <algorithm>
#include <cmath>

namespace obscura::voxel {

Window::Window(uint32_t cells) : m_side(cells / kBrickSide), m_bricks(size_t(m_side) * m_side * m_side), m_isChanged(m_bricks.size()) {}

bool Window::holds(const glm::ivec3& place) const {
    const glm::ivec3 p = place - m_origin;
    return m_placed && glm::all(glm::greaterThanEqual(p, glm::ivec3(0))) && glm::all(glm::lessThan(p, glm::ivec3(int(m_side))));
}

uint32_t Window::addressOf(const glm::ivec3& place) const {
    const glm::uvec3 p = glm::uvec3(place) & (m_side - 1);  // a power of two: also correct for negative places
    return (p.x * m_side + p.y) * m_side + p.z;
}

void Window::compose(const glm::ivec3& place, const Compose& compose) {
    Brick brick;
    compose(place, brick);
    const uint32_t address = addressOf(place);
    if (brick == m_bricks[address]) return;
    m_bricks[address] = brick;
    if (!m_isChanged[address]) m_changed.push_back(address);
    m_isChanged[address] = true;
}

void Window::update(const glm::ivec3& origin, std::span<const glm::ivec3> changed, bool all, const Compose& fill) {
    const bool kept = m_placed && !all;
    const glm::ivec3 old = m_origin, end = origin + int(m_side);
    const auto entered = [&](const glm::ivec3& place) {
        const glm::ivec3 p = place - old;
        return !kept || std::min({p.x, p.y, p.z}) < 0 || std::max({p.x, p.y, p.z}) >= int(m_side);
    };
    m_placed = true;
    m_origin = origin;
    if (!kept || origin != old) {
        glm::ivec3 place;
        for (place.x = origin.x; place.x < end.x; ++place.x)
            for (place.y = origin.y; place.y < end.y; ++place.y)
                for (place.z = origin.z; place.z < end.z; ++place.z)
                    if (entered(place)) compose(place, fill);
    }
    if (!all)
        for (const glm::ivec3& place : changed)
            if (holds(place)) compose(place, fill);
}

std::vector<uint32_t> Window::takeChanged(bool all) {
    std::vector<uint32_t> taken;
    for (const uint32_t address : m_changed) m_isChanged[address] = false;
    taken.swap(m_changed);
    if (all) {
        taken.clear();
        for (uint32_t address = 0; address < m_bricks.size(); ++address)
            if (!m_bricks[address].empty()) taken.push_back(address);
    }
    std::sort(taken.begin(), taken.end());
    return taken;
}

glm::ivec3 centreBrick(double cellSize, const glm::vec3& eye) {
    const double most = double(kMostCell / kBrickSide / 2);
    glm::ivec3 centre;
    for (int k = 0; k < 3; ++k) centre[k] = int(std::clamp(std::floor((double(eye[k]) / cellSize + 0.5) / kBrickSide), -most, most));
    return centre;
}

glm::ivec3 windowOrigin(uint32_t cells, uint32_t level, const glm::ivec3& centre) {
    return atLevel(centre, level) - int(cells / kBrickSide / 2);
}

}  // namespace obscura::voxel
