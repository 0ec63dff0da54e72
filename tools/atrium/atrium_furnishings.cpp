// Pots, plants, benches and the lantern.
#include "atrium/atrium_parts.h"
#include "meshkit/image.h"
#include "meshkit/shapes.h"

#include <cmath>

namespace obscura::atrium {

using namespace kit;

namespace {

constexpr float kPotHeight = 0.62f;

Geometry finished(Mesh mesh, float creaseDegrees) {
    boxMapTexcoords(mesh, 1.0f);
    smoothNormals(mesh, creaseDegrees);
    return {std::move(mesh), {}, {}};
}

}  // namespace

Geometry makePot() {
    const Profile profile{{0.0f, 0.0f}, {0.18f, 0.0f}, {0.195f, 0.012f}, {0.2f, 0.04f}, {0.185f, 0.065f}, {0.2f, 0.1f}, {0.26f, 0.2f},
        {0.3f, 0.31f}, {0.315f, 0.41f}, {0.305f, 0.49f}, {0.28f, 0.54f}, {0.275f, 0.56f}, {0.3f, 0.572f}, {0.33f, 0.58f}, {0.34f, 0.6f},
        {0.33f, 0.618f}, {0.3f, kPotHeight}, {0.27f, 0.61f}, {0.255f, 0.58f}, {0.25f, 0.54f}, {0.0f, 0.55f}};
    Mesh mesh = lathe(profile, 24, [&](std::size_t ring, std::size_t) { return ring + 2 == profile.size() ? kSoil : kTerracotta; });
    return finished(std::move(mesh), 60.0f);
}

Geometry makePlant() {
    constexpr int kLeaves = 44;
    constexpr int kSteps = 4;
    Mesh mesh;
    for (std::uint32_t i = 0; i < kLeaves; ++i) {
        const float turn = 137.5f * static_cast<float>(i) + 20.0f * hash01(i, 1);
        const float rise = 0.35f + 0.85f * hash01(i, 2);
        const float reach = 0.85f - 0.35f * rise;
        const float halfWidth = 0.09f + 0.05f * hash01(i, 3);
        // A frond that climbs, bows over under its weight, and droops at its tip.
        Mesh frond;
        for (int s = 0; s <= kSteps; ++s) {
            const float t = static_cast<float>(s) / kSteps;
            const glm::vec3 spine(0.0f, kPotHeight - 0.09f + rise * (1.6f * t - 0.9f * t * t), 0.05f + reach * t * t);
            frond.addVertex(spine - glm::vec3(halfWidth, 0, 0), {0.0f, 1.0f - t});
            frond.addVertex(spine + glm::vec3(halfWidth, 0, 0), {1.0f, 1.0f - t});
            if (s > 0) {
                const auto at = static_cast<std::uint32_t>(2 * s);
                frond.addQuad(at - 2, at - 1, at + 1, at, kLeaf);
            }
        }
        mesh.append(frond, rotation(turn, {0, 1, 0}));
    }
    smoothNormals(mesh, 60.0f);
    return {mesh, {}, {}};
}

Geometry makeChainLink() {
    // Two links at right angles, so that copies along y make a chain; the step is 0.24 m.
    Mesh mesh;
    const Mesh one = link(0.045f, 0.034f, 0.0105f, 16, 7);
    mesh.append(one, rotation(90, {1, 0, 0}));
    mesh.append(one, translation({0, -0.12f, 0}) * rotation(90, {0, 1, 0}) * rotation(90, {1, 0, 0}));
    mesh.setMaterial(kIron);
    return finished(std::move(mesh), 60.0f);
}

Geometry makeLantern() {
    Mesh iron;
    constexpr int kSides = 8;
    constexpr float kRadius = 0.24f;
    const auto ringAt = [&](float y, float halfHeight, float radius) {
        iron.append(lathe({{radius - 0.035f, y - halfHeight}, {radius, y - halfHeight}, {radius + 0.008f, y}, {radius, y + halfHeight},
                              {radius - 0.035f, y + halfHeight}, {radius - 0.035f, y - halfHeight}},
            kSides));
    };
    ringAt(-0.3f, 0.025f, kRadius);
    ringAt(-0.78f, 0.03f, kRadius);
    for (int i = 0; i < kSides; ++i)
        iron.append(chamferBox({-0.012f, -0.78f, -0.012f}, {0.012f, -0.3f, 0.012f}, 0.004f),
            rotation(360.0f / kSides * static_cast<float>(i), {0, 1, 0}) * translation({0, 0, kRadius - 0.018f}));
    // The roof with its eye, and the pan below with a drop.
    iron.append(lathe({{0.0f, -0.3f}, {0.27f, -0.285f}, {0.28f, -0.27f}, {0.2f, -0.2f}, {0.11f, -0.14f}, {0.05f, -0.1f}, {0.035f, -0.06f},
                          {0.045f, -0.045f}, {0.0f, -0.03f}},
        24));
    iron.append(torus(0.04f, 0.011f, 16, 8), rotation(90, {1, 0, 0}));
    iron.append(lathe({{0.0f, -0.94f}, {0.02f, -0.93f}, {0.025f, -0.9f}, {0.012f, -0.87f}, {0.08f, -0.84f}, {0.19f, -0.81f},
                          {0.22f, -0.79f}, {0.0f, -0.78f}},
        24));
    iron.setMaterial(kIron);
    Mesh candle = lathe({{0.0f, -0.785f}, {0.06f, -0.785f}, {0.062f, -0.56f}, {0.05f, -0.55f}, {0.0f, -0.555f}}, 16);
    candle.setMaterial(kGlow);
    iron.append(candle);
    return finished(std::move(iron), 45.0f);
}

Geometry makeBench() {
    Mesh mesh;
    for (float x : {-0.62f, 0.62f}) {
        mesh.append(chamferBox({x - 0.09f, 0.0f, -0.19f}, {x + 0.09f, 0.08f, 0.19f}, 0.012f));
        mesh.append(chamferBox({x - 0.065f, 0.07f, -0.16f}, {x + 0.065f, 0.38f, 0.16f}, 0.012f));
    }
    mesh.setMaterial(kStone);
    for (float z : {-0.135f, 0.0f, 0.135f}) {
        Mesh plank = roundedBox({0.9f, 0.032f, 0.06f}, 0.014f);
        plank.setMaterial(kWood);
        mesh.append(plank, translation({0, 0.408f, z}));
    }
    return finished(std::move(mesh), 45.0f);
}

}  // namespace obscura::atrium
