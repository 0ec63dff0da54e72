#include "toasters/tray.h"

#include "meshkit/shapes.h"
#include "toasters/toaster_model.h"

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace obscura::toasters {

using namespace kit;

namespace {

// The floor is cut into cells along these lines; some cells hold a recess.
constexpr std::array kColumns{-2.2f, -1.62f, -0.78f, -0.3f, 0.3f, 0.78f, 1.62f, 2.2f};
constexpr std::array kRows{-1.36f, -0.82f, -0.42f, 0.42f, 0.82f, 1.36f};
/// Points along each side of a cell, so that neighbours meet without cracks.
constexpr int kSidePoints = 5;
constexpr float kRecessDepth = 0.032f;

/// A cell's border, counter-clockwise from above, beginning in the middle of its +z side.
std::vector<glm::vec2> cellBorder(glm::vec2 low, glm::vec2 high) {
    std::vector<glm::vec2> border;
    const std::array<glm::vec2, 4> corners{glm::vec2(low.x, high.y), high, glm::vec2(high.x, low.y), low};
    for (int side = 0; side < 4; ++side)
        for (int i = 0; i < kSidePoints; ++i)
            border.push_back(glm::mix(corners[side], corners[(side + 1) % 4], static_cast<float>(i) / static_cast<float>(kSidePoints)));
    return border;
}

Ring borderRing(const std::vector<glm::vec2>& border, float y) {
    Ring ring;
    for (glm::vec2 p : border) ring.emplace_back(p.x, y, p.y);
    return ring;
}

/// A flat cell, or with a radius above zero one with a dished recess.
Mesh makeCell(glm::vec2 low, glm::vec2 high, float radius) {
    const glm::vec2 centre = 0.5f * (low + high);
    const std::vector<glm::vec2> border = cellBorder(low, high);
    std::vector<Ring> rings{borderRing(border, kTrayFloor)};
    struct Step {
        float inset;
        float depth;
    };
    const std::vector<Step> steps{{-0.006f, 0.0f}, {0.001f, 0.002f}, {0.005f, 0.007f}, {0.02f, 0.029f}, {0.034f, kRecessDepth}};
    if (radius > 0.0f)
        for (const Step& step : steps) {
            Ring ring;
            for (glm::vec2 p : border) {
                const glm::vec2 q = centre + glm::normalize(p - centre) * (radius - step.inset);
                ring.emplace_back(q.x, kTrayFloor - step.depth, q.y);
            }
            rings.push_back(ring);
        }
    const float bottom = radius > 0.0f ? kTrayFloor - kRecessDepth : kTrayFloor;
    rings.push_back(Ring(border.size(), glm::vec3(centre.x, bottom, centre.y)));
    return loft(
        rings, [&](std::size_t ring, std::size_t) { return radius > 0.0f && ring >= 1 && ring + 2 < rings.size() ? kDarkWood : kWood; });
}

float recessRadius(std::size_t column, std::size_t row) {
    const bool isCorner = (column == 0 || column == 6) && (row == 0 || row == 4);
    const bool isLarge = (column == 1 || column == 5) && row == 2;
    const bool isCentre = column == 3 && row == 2;
    return isLarge ? 0.34f : isCorner || isCentre ? 0.2f : 0.0f;
}

/// The floor's border moved outwards by `offset`: its corners open into quarter circles.
Ring rimRing(float offset, float y) {
    constexpr int kCornerSteps = 5;
    Ring ring;
    const auto side = [&](glm::vec2 outwards, const auto& lines, bool forwards, glm::vec2 fixed, glm::vec2 along) {
        for (std::size_t cell = 0; cell + 1 < lines.size(); ++cell)
            for (int i = 0; i <= kSidePoints; ++i) {
                if (i == kSidePoints && cell + 2 < lines.size()) continue;
                const std::size_t a = forwards ? cell : lines.size() - 1 - cell;
                const std::size_t b = forwards ? cell + 1 : lines.size() - 2 - cell;
                const float at = glm::mix(lines[a], lines[b], static_cast<float>(i) / static_cast<float>(kSidePoints));
                const glm::vec2 p = fixed + along * at + outwards * offset;
                ring.emplace_back(p.x, y, p.y);
            }
    };
    const auto corner = [&](glm::vec2 at, float startDegrees) {
        for (int i = 1; i < kCornerSteps; ++i) {
            const float angle = glm::radians(startDegrees + 90.0f * static_cast<float>(i) / static_cast<float>(kCornerSteps));
            ring.emplace_back(at.x + offset * std::sin(angle), y, at.y + offset * std::cos(angle));
        }
    };
    side({0, 1}, kColumns, true, {0, kRows.back()}, {1, 0});
    corner({kColumns.back(), kRows.back()}, 0.0f);
    side({1, 0}, kRows, false, {kColumns.back(), 0}, {0, 1});
    corner({kColumns.back(), kRows.front()}, 90.0f);
    side({0, -1}, kColumns, false, {0, kRows.front()}, {1, 0});
    corner({kColumns.front(), kRows.front()}, 180.0f);
    side({-1, 0}, kRows, true, {kColumns.front(), 0}, {0, 1});
    corner({kColumns.front(), kRows.back()}, 270.0f);
    return ring;
}

}  // namespace

Geometry makeTray() {
    Mesh mesh;
    for (std::size_t column = 0; column + 1 < kColumns.size(); ++column)
        for (std::size_t row = 0; row + 1 < kRows.size(); ++row)
            mesh.append(makeCell({kColumns[column], kRows[row]}, {kColumns[column + 1], kRows[row + 1]}, recessRadius(column, row)));

    // From under the tray up its outer wall, over the rim and down to the floor.
    const std::vector<glm::vec2> profile{{0.05f, 0.0f}, {0.075f, 0.006f}, {0.1f, 0.1f}, {0.112f, 0.125f}, {0.103f, 0.142f}, {0.08f, 0.147f},
        {0.054f, 0.134f}, {0.024f, kTrayFloor + 0.006f}, {0.0f, kTrayFloor}};
    std::vector<Ring> rings;
    rings.push_back(Ring(rimRing(0.0f, 0.0f).size(), glm::vec3(0.0f)));
    for (glm::vec2 p : profile) rings.push_back(rimRing(p.x, p.y));
    mesh.append(loft(rings, [](std::size_t ring, std::size_t) { return ring >= 3 && ring <= 6 ? kDarkWood : kWood; }));
    boxMapTexcoords(mesh, 1.2f);
    smoothNormals(mesh, 45.0f);
    return {mesh, {}, {}};
}

}  // namespace obscura::toasters
