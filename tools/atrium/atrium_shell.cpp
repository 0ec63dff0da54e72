// Floors, walls and cornices.
#include "atrium/atrium_parts.h"
#include "meshkit/shapes.h"

#include <algorithm>
#include <array>

namespace obscura::atrium {

using namespace kit;

namespace {

/// The court-side face of the arcade, which mouldings are measured from.
constexpr float kFaceX = kCourtX - 0.5f * kArchDepth;
constexpr float kFaceZ = kCourtZ - 0.5f * kArchDepth;

Ring rectangle(float halfX, float halfZ, float y) {
    return {{-halfX, y, halfZ}, {halfX, y, halfZ}, {halfX, y, -halfZ}, {-halfX, y, -halfZ}};
}

Geometry finished(Mesh mesh, float metresPerTile) {
    boxMapTexcoords(mesh, metresPerTile);
    smoothNormals(mesh, 38.0f);
    return {std::move(mesh), {}, {}};
}

/// Tiles with bevelled edges over a bed that shows in the grooves.
void addTiles(Mesh& mesh, glm::vec2 low, glm::vec2 high, int columns, int rows, bool chequered) {
    constexpr float kGroove = 0.004f;
    constexpr float kBevel = 0.008f;
    constexpr float kDepth = 0.01f;
    const glm::vec2 size = (high - low) / glm::vec2(columns, rows);
    for (int column = 0; column < columns; ++column)
        for (int row = 0; row < rows; ++row) {
            const glm::vec2 a = low + size * glm::vec2(column, row);
            const glm::vec2 centre = a + 0.5f * size;
            const glm::vec2 foot = 0.5f * size - kGroove;
            const glm::vec2 top = foot - kBevel;
            const auto at = [&](glm::vec2 half, float y) {
                Ring ring = rectangle(half.x, half.y, y);
                for (glm::vec3& p : ring) p += glm::vec3(centre.x, 0.0f, centre.y);
                return ring;
            };
            const std::array<Ring, 3> rings{at(foot, -kDepth), at(top, 0.0f), Ring(4, {centre.x, 0.0f, centre.y})};
            Mesh tile = loft(rings);
            tile.setMaterial(chequered && (column + row) % 2 == 0 ? kDarkStone : kTiles);
            mesh.append(tile);
        }
    mesh.addFace({low.x, -kDepth, high.y}, {high.x, -kDepth, high.y}, {high.x, -kDepth, low.y}, {low.x, -kDepth, low.y}, kDarkStone);
}

}  // namespace

Geometry makeCourtFloor() {
    constexpr int kTilesPerBay = 3;
    Mesh mesh;
    addTiles(mesh, {-kCourtX, -kCourtZ}, {kCourtX, kCourtZ}, kBaysLong * kTilesPerBay, kBaysShort * kTilesPerBay, true);
    return finished(std::move(mesh), 1.6f);
}

Geometry makeWalkFloor() {
    constexpr int kAcross = 4;
    Mesh mesh;
    for (float side : {-1.0f, 1.0f}) {
        const float z0 = side > 0.0f ? kCourtZ : -kOuterZ;
        addTiles(mesh, {-kOuterX, z0}, {kOuterX, z0 + kWalk}, 36, kAcross, false);
        const float x0 = side > 0.0f ? kCourtX : -kOuterX;
        addTiles(mesh, {x0, -kCourtZ}, {x0 + kWalk, kCourtZ}, kAcross, 10, false);
    }
    return finished(std::move(mesh), 1.6f);
}

Geometry makeSlab(float bottom, float top) {
    // The slab runs a little way into the outer wall, so that no crack of light shows.
    constexpr float kIntoWall = 0.1f;
    const std::array<Ring, 5> rings{rectangle(kFaceX, kFaceZ, bottom), rectangle(kOuterX + kIntoWall, kOuterZ + kIntoWall, bottom),
        rectangle(kOuterX + kIntoWall, kOuterZ + kIntoWall, top), rectangle(kFaceX, kFaceZ, top), rectangle(kFaceX, kFaceZ, bottom)};
    Mesh mesh = loft(rings);
    mesh.setMaterial(kPlaster);
    Mesh beams;
    const auto beam = [&](glm::vec2 low, glm::vec2 high) {
        beams.append(chamferBox({low.x, bottom - 0.22f, low.y}, {high.x, bottom + 0.02f, high.y}, 0.02f));
    };
    constexpr float kHalfBeam = 0.13f;
    constexpr float kClear = 0.5f * kArchDepth - 0.04f;
    for (float side : {-1.0f, 1.0f}) {
        const auto across = [&](float inner, float outer) {
            return glm::vec2(std::min(side * inner, side * outer), std::max(side * inner, side * outer));
        };
        const glm::vec2 z = across(kCourtZ + kClear, kOuterZ + 0.05f);
        for (int i = 0; i <= kBaysLong; ++i) {
            const float x = -kCourtX + kBay * static_cast<float>(i);
            beam({x - kHalfBeam, z.x}, {x + kHalfBeam, z.y});
        }
        const glm::vec2 x = across(kCourtX + kClear, kOuterX + 0.05f);
        for (int i = 0; i <= kBaysShort; ++i) {
            const float at = -kCourtZ + kBay * static_cast<float>(i);
            beam({x.x, at - kHalfBeam}, {x.y, at + kHalfBeam});
        }
    }
    beams.setMaterial(kWood);
    mesh.append(beams);
    return finished(std::move(mesh), 2.0f);
}

Geometry makeOuterWalls() {
    constexpr float kFoot = -0.4f;
    constexpr float kTop = kRoofTop + 0.45f;
    const std::array<Ring, 5> rings{rectangle(kOuterX, kOuterZ, kFoot),
        rectangle(kOuterX + kWallThickness, kOuterZ + kWallThickness, kFoot),
        rectangle(kOuterX + kWallThickness, kOuterZ + kWallThickness, kTop), rectangle(kOuterX, kOuterZ, kTop),
        rectangle(kOuterX, kOuterZ, kFoot)};
    Mesh mesh = loft(rings);
    mesh.setMaterial(kPlaster);
    // The ground beneath, which closes the building from below.
    const Ring ground = rectangle(kOuterX + 0.1f, kOuterZ + 0.1f, -0.3f);
    const Ring bed = rectangle(kOuterX + 0.1f, kOuterZ + 0.1f, -0.02f);
    const std::array<Ring, 4> base{Ring(4, {0, -0.3f, 0}), ground, bed, Ring(4, {0, -0.02f, 0})};
    Mesh bedding = loft(base);
    bedding.setMaterial(kDarkStone);
    mesh.append(bedding);

    const auto pilaster = [&](glm::vec3 foot, float degrees, float height) {
        Mesh part;
        part.append(chamferBox({-0.33f, 0.0f, -0.05f}, {0.33f, 0.22f, 0.3f}, 0.015f));
        part.append(chamferBox({-0.28f, 0.2f, -0.05f}, {0.28f, height - 0.14f, 0.22f}, 0.015f));
        part.append(chamferBox({-0.34f, height - 0.16f, -0.05f}, {0.34f, height, 0.29f}, 0.015f));
        mesh.append(part, translation(foot) * rotation(degrees, {0, 1, 0}));
    };
    for (int storey = 0; storey < 2; ++storey) {
        const float y = kStoreyHeight * static_cast<float>(storey);
        const float height = storey == 0 ? kLowerColumn : kUpperColumn;
        for (int i = 0; i <= kBaysLong; ++i) {
            const float x = -kCourtX + kBay * static_cast<float>(i);
            pilaster({x, y, -kOuterZ}, 0.0f, height);
            pilaster({x, y, kOuterZ}, 180.0f, height);
        }
        for (int i = 0; i <= kBaysShort; ++i) {
            const float z = -kCourtZ + kBay * static_cast<float>(i);
            pilaster({-kOuterX, y, z}, 90.0f, height);
            pilaster({kOuterX, y, z}, -90.0f, height);
        }
    }
    return finished(std::move(mesh), 2.0f);
}

Geometry makeCornice(float y, float projection) {
    struct Step {
        float out;
        float down;
    };
    const std::array<Step, 12> steps{Step{-0.1f, 0.0f}, {projection - 0.015f, 0.0f}, {projection, 0.015f}, {projection, 0.06f},
        {projection - 0.03f, 0.085f}, {0.6f * projection, 0.12f}, {0.45f * projection, 0.17f}, {0.4f * projection, 0.18f},
        {0.4f * projection, 0.23f}, {0.15f * projection, 0.29f}, {0.12f * projection, 0.42f}, {-0.1f, 0.44f}};
    std::vector<Ring> rings;
    rings.reserve(steps.size() + 1);
    for (const Step& step : steps) rings.push_back(rectangle(kFaceX - step.out, kFaceZ - step.out, y - step.down));
    rings.push_back(rings.front());
    return finished(loft(rings), 2.0f);
}

Geometry makeBrackets() {
    constexpr int kPerBay = 3;
    Mesh mesh;
    // Seen from the side: a console that swells towards the cornice it carries.
    const Profile side{{-0.05f, -0.36f}, {0.03f, -0.36f}, {0.07f, -0.33f}, {0.085f, -0.27f}, {0.13f, -0.22f}, {0.19f, -0.19f},
        {0.2f, -0.12f}, {0.2f, -0.09f}, {-0.05f, -0.09f}};
    for (int i = 0; i < kPerBay; ++i) {
        const float x = kBay * ((static_cast<float>(i) + 0.5f) / kPerBay - 0.5f);
        mesh.append(bevelledPrism(side, -0.06f, 0.06f, 0.008f), translation({x, 0, 0}) * rotation(-90, {0, 1, 0}));
    }
    return finished(std::move(mesh), 2.0f);
}

}  // namespace obscura::atrium
