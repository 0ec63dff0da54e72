// Columns, piers and balusters.
#include "atrium/atrium_parts.h"
#include "meshkit/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace obscura::atrium {

using namespace kit;

namespace {

constexpr float kShaftRadius = 0.215f;
constexpr float kBaseHeight = 0.27f;
constexpr float kCapitalHeight = 0.42f;
constexpr float kPlinthHalf = 0.31f;
constexpr float kPlinthHeight = 0.11f;
constexpr int kFlutes = 14;
constexpr int kPointsPerFlute = 4;

/// The shaft narrows upwards along a gentle curve, so that it does not look pinched.
float entasis(float t) { return 1.0f - 0.16f * t * t; }

Ring flutedRing(float radius, float depth, float y) {
    Ring ring;
    for (int i = 0; i < kFlutes * kPointsPerFlute; ++i) {
        const float angle = glm::two_pi<float>() * static_cast<float>(i) / (kFlutes * kPointsPerFlute);
        // One point lies on the ridge between flutes, the other three in the hollow.
        constexpr float kHollow[kPointsPerFlute] = {0.0f, 0.72f, 1.0f, 0.72f};
        const float r = radius * (1.0f - depth * kHollow[i % kPointsPerFlute]);
        ring.emplace_back(r * std::sin(angle), y, r * std::cos(angle));
    }
    return ring;
}

Mesh makeShaft(float low, float high) {
    constexpr float kFluteDepth = 0.085f;
    constexpr float kFade = 0.07f;
    std::vector<Ring> rings;
    const auto add = [&](float y, float depth) { rings.push_back(flutedRing(kShaftRadius * entasis((y - low) / (high - low)), depth, y)); };
    rings.push_back(Ring(kFlutes * kPointsPerFlute, {0.0f, low, 0.0f}));
    add(low, 0.0f);
    add(low + kFade, 0.0f);
    constexpr int kMiddle = 3;
    for (int i = 0; i <= kMiddle; ++i) add(glm::mix(low + 1.6f * kFade, high - 1.6f * kFade, static_cast<float>(i) / kMiddle), kFluteDepth);
    add(high - kFade, 0.0f);
    add(high, 0.0f);
    rings.push_back(Ring(kFlutes * kPointsPerFlute, {0.0f, high, 0.0f}));
    return loft(rings);
}

/// Leaves that stand out from the bell of the capital, in two rows.
Mesh makeLeaves(float bottom, float radius) {
    Mesh mesh;
    constexpr int kPerRow = 8;
    for (int row = 0; row < 2; ++row)
        for (int i = 0; i < kPerRow; ++i) {
            const float turn = (static_cast<float>(i) + 0.5f * static_cast<float>(row)) * 360.0f / kPerRow;
            const float height = row == 0 ? 0.13f : 0.22f;
            // A tongue that rises along the bell and curls outwards at its tip.
            std::vector<Ring> rings;
            for (int s = 0; s <= 3; ++s) {
                const float t = static_cast<float>(s) / 3.0f;
                const float curl = t * t * t;
                const float width = 0.06f * std::sqrt(std::max(0.0f, 1.0f - curl));
                const glm::vec3 spine(0.0f, bottom + height * (t - 0.25f * curl), radius + 0.015f + 0.075f * curl);
                rings.push_back({spine + glm::vec3(0, 0, 0.02f), spine + glm::vec3(width, 0, 0), spine - glm::vec3(0, 0.012f * curl, 0.03f),
                    spine - glm::vec3(width, 0, 0)});
            }
            const auto close = [](const Ring& ring) { return Ring(4, 0.25f * (ring[0] + ring[1] + ring[2] + ring[3])); };
            rings.insert(rings.begin(), close(rings.front()));
            rings.push_back(close(rings.back()));
            mesh.append(loft(rings), rotation(turn, {0, 1, 0}));
        }
    return mesh;
}

Mesh makePlinth(float y) { return chamferBox({-kPlinthHalf, y, -kPlinthHalf}, {kPlinthHalf, y + kPlinthHeight, kPlinthHalf}, 0.012f); }

}  // namespace

Geometry makeColumn(float height) {
    Mesh mesh;
    mesh.append(makePlinth(0.0f));
    // The Attic base: two rolls with a hollow between them.
    const float r = kShaftRadius;
    Profile base{{0.0f, kPlinthHeight}};
    const auto roll = [&](float inner, float middle, float half) {
        for (int i = 0; i <= 3; ++i) {
            const float angle = glm::radians(-75.0f + 50.0f * static_cast<float>(i));
            base.emplace_back(inner + half * std::cos(angle), middle + half * std::sin(angle));
        }
    };
    roll(r + 0.045f, kPlinthHeight + 0.036f, 0.036f);
    base.emplace_back(r + 0.022f, kPlinthHeight + 0.085f);
    roll(r + 0.018f, kPlinthHeight + 0.122f, 0.024f);
    base.emplace_back(r + 0.008f, kBaseHeight - 0.008f);
    base.emplace_back(0.0f, kBaseHeight - 0.004f);
    mesh.append(lathe(base, 20));

    const float neck = height - kCapitalHeight;
    mesh.append(makeShaft(kBaseHeight - 0.006f, neck + 0.01f));

    const float top = r * entasis(1.0f);
    const Profile bell{{0.0f, neck - 0.03f}, {top + 0.008f, neck - 0.03f}, {top + 0.028f, neck - 0.018f}, {top + 0.028f, neck - 0.002f},
        {top + 0.004f, neck + 0.012f}, {top + 0.01f, neck + 0.1f}, {top + 0.03f, neck + 0.2f}, {top + 0.075f, neck + 0.275f},
        {top + 0.1f, neck + 0.29f}, {top + 0.1f, neck + 0.31f}, {0.0f, neck + 0.312f}};
    mesh.append(lathe(bell, 20));
    mesh.append(makeLeaves(neck + 0.012f, top));
    // Small scrolls under the corners of the abacus.
    for (int corner = 0; corner < 4; ++corner) {
        const glm::mat4 turn = rotation(45.0f + 90.0f * static_cast<float>(corner), {0, 1, 0});
        mesh.append(cylinder(0.042f, 0.07f, 0.012f, 8), turn * translation({0.035f, neck + 0.258f, 0.3f}) * rotation(90, {0, 0, 1}));
    }
    mesh.append(chamferBox({-0.29f, neck + 0.3f, -0.29f}, {0.29f, neck + 0.355f, 0.29f}, 0.014f));
    mesh.append(chamferBox({-0.32f, neck + 0.35f, -0.32f}, {0.32f, height, 0.32f}, 0.014f));
    boxMapTexcoords(mesh, 2.0f);
    smoothNormals(mesh, 38.0f);
    return {mesh, {}, {}};
}

Geometry makePier(float height) {
    Mesh mesh;
    constexpr float kHalf = 0.29f;
    mesh.append(chamferBox({-0.34f, 0.0f, -0.34f}, {0.34f, 0.16f, 0.34f}, 0.015f));
    mesh.append(chamferBox({-0.315f, 0.15f, -0.315f}, {0.315f, 0.25f, 0.315f}, 0.02f));
    mesh.append(chamferBox({-kHalf, 0.24f, -kHalf}, {kHalf, height - 0.2f, kHalf}, 0.025f));
    // A raised panel on each face catches the light.
    for (int side = 0; side < 4; ++side)
        mesh.append(chamferBox({-0.18f, 0.45f, kHalf - 0.02f}, {0.18f, height - 0.42f, kHalf + 0.018f}, 0.012f),
            rotation(90.0f * static_cast<float>(side), {0, 1, 0}));
    mesh.append(chamferBox({-0.31f, height - 0.22f, -0.31f}, {0.31f, height - 0.12f, 0.31f}, 0.015f));
    mesh.append(chamferBox({-0.35f, height - 0.13f, -0.35f}, {0.35f, height, 0.35f}, 0.018f));
    boxMapTexcoords(mesh, 2.0f);
    smoothNormals(mesh, 38.0f);
    return {mesh, {}, {}};
}

Geometry makeBaluster() {
    Mesh mesh;
    const Profile turned{{0.0f, 0.115f}, {0.065f, 0.115f}, {0.065f, 0.165f}, {0.036f, 0.185f}, {0.052f, 0.23f}, {0.072f, 0.3f},
        {0.062f, 0.39f}, {0.036f, 0.51f}, {0.03f, 0.61f}, {0.036f, 0.66f}, {0.058f, 0.69f}, {0.04f, 0.72f}, {0.06f, 0.795f},
        {0.0f, 0.795f}};
    mesh.append(lathe(turned, 10));
    boxMapTexcoords(mesh, 2.0f);
    smoothNormals(mesh, 50.0f);
    return {mesh, {}, {}};
}

Geometry makeRail() {
    Mesh mesh;
    constexpr float kHalf = 0.5f * kBay - 0.2f;
    mesh.append(chamferBox({-kHalf, 0.0f, -0.11f}, {kHalf, 0.12f, 0.11f}, 0.012f));
    mesh.append(chamferBox({-kHalf, 0.79f, -0.1f}, {kHalf, 0.85f, 0.1f}, 0.014f));
    mesh.append(chamferBox({-kHalf, 0.84f, -0.13f}, {kHalf, 0.92f, 0.13f}, 0.02f));
    mesh.setMaterial(kStone);
    boxMapTexcoords(mesh, 2.0f);
    smoothNormals(mesh, 38.0f);
    return {mesh, {}, {}};
}

}  // namespace obscura::atrium
