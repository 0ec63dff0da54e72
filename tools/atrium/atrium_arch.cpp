// Arches of the arcade.
#include "atrium/atrium_parts.h"
#include "meshkit/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace obscura::atrium {

using namespace kit;

namespace {

constexpr float kHalfBay = 0.5f * kBay;
constexpr int kVoussoirs = 11;
constexpr int kStepsPerStone = 2;
/// The wall's own opening lies behind the stones, which form the visible soffit.
constexpr float kWallRadius = kArchRadius + 0.06f;
constexpr float kStoneTop = kArchRadius + 0.26f;

glm::vec2 onArch(float radius, float t) {
    const float angle = glm::pi<float>() * (1.0f - t);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// The wall above and beside the opening.
Mesh makeSpandrel() {
    constexpr float kZ = 0.5f * kArchDepth - 0.035f;
    constexpr int kSteps = kVoussoirs * kStepsPerStone;
    Mesh mesh;
    const auto strip = [&](glm::vec2 low0, glm::vec2 low1, glm::vec2 high0, glm::vec2 high1) {
        mesh.addFace({low0, kZ}, {low1, kZ}, {high1, kZ}, {high0, kZ}, kPlaster);
        mesh.addFace({low1, -kZ}, {low0, -kZ}, {high0, -kZ}, {high1, -kZ}, kPlaster);
        mesh.addFace({high0, kZ}, {high1, kZ}, {high1, -kZ}, {high0, -kZ}, kPlaster);
    };
    strip({-kHalfBay, 0}, {-kWallRadius, 0}, {-kHalfBay, kArchHeight}, {-kWallRadius, kArchHeight});
    strip({kWallRadius, 0}, {kHalfBay, 0}, {kWallRadius, kArchHeight}, {kHalfBay, kArchHeight});
    for (int i = 0; i < kSteps; ++i) {
        const glm::vec2 a = onArch(kWallRadius, static_cast<float>(i) / kSteps);
        const glm::vec2 b = onArch(kWallRadius, static_cast<float>(i + 1) / kSteps);
        strip(a, b, {a.x, kArchHeight}, {b.x, kArchHeight});
        mesh.addFace({a, -kZ}, {b, -kZ}, {b, kZ}, {a, kZ}, kPlaster);
    }
    for (float side : {-1.0f, 1.0f}) {
        const float inner = side * kWallRadius;
        const float outer = side * kHalfBay;
        const float left = std::min(inner, outer);
        const float right = std::max(inner, outer);
        mesh.addFace({left, 0, -kZ}, {right, 0, -kZ}, {right, 0, kZ}, {left, 0, kZ}, kPlaster);
        mesh.addFace(
            {outer, 0, side * kZ}, {outer, 0, -side * kZ}, {outer, kArchHeight, -side * kZ}, {outer, kArchHeight, side * kZ}, kPlaster);
    }
    return mesh;
}

/// One wedge of the arch; the keystone is taller and protrudes further than the others.
Mesh makeVoussoir(int index) {
    constexpr float kJoint = 0.0012f;
    const bool isKey = index == kVoussoirs / 2;
    const float inner = isKey ? kArchRadius - 0.02f : kArchRadius;
    const float outer = isKey ? kStoneTop + 0.07f : kStoneTop;
    const float halfDepth = 0.5f * kArchDepth + (isKey ? 0.04f : 0.01f);
    const float from = static_cast<float>(index) / kVoussoirs + kJoint;
    const float to = static_cast<float>(index + 1) / kVoussoirs - kJoint;
    Profile outline;
    for (int i = 0; i <= kStepsPerStone; ++i) outline.push_back(onArch(outer, glm::mix(to, from, static_cast<float>(i) / kStepsPerStone)));
    for (int i = 0; i <= kStepsPerStone; ++i) outline.push_back(onArch(inner, glm::mix(from, to, static_cast<float>(i) / kStepsPerStone)));
    return bevelledPrism(outline, -halfDepth, halfDepth, 0.009f);
}

}  // namespace

Geometry makeArch(bool isBlind) {
    Mesh mesh = makeSpandrel();
    for (int i = 0; i < kVoussoirs; ++i) mesh.append(makeVoussoir(i));
    // A round shield in each spandrel; a blind arch's back lies in the wall and needs none.
    for (float side : {-1.0f, 1.0f})
        for (float face : isBlind ? std::vector{1.0f} : std::vector{-1.0f, 1.0f})
            mesh.append(lathe({{0.0f, -0.02f}, {0.13f, -0.02f}, {0.135f, 0.012f}, {0.105f, 0.024f}, {0.085f, 0.008f}, {0.0f, 0.03f}}, 12),
                translation({side * 1.03f, 1.13f, face * (0.5f * kArchDepth - 0.035f)}) * rotation(90.0f * face, {1, 0, 0}));
    boxMapTexcoords(mesh, 2.0f);
    smoothNormals(mesh, 38.0f);
    return {mesh, {}, {}};
}

}  // namespace obscura::atrium
