#include "toasters/toaster_model.h"

#include "meshkit/shapes.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace obscura::toasters {

using namespace kit;

namespace {

// The body's plan: a rounded ellipse, roomy in front for the round jaw.
constexpr glm::vec2 kBodyHalf{0.162f, 0.15f};
constexpr float kBodyExponent = 2.5f;
constexpr int kBodySegments = 22;

constexpr glm::vec2 kSlotHalf{0.1f, 0.023f};
constexpr glm::vec2 kSlotLipHalf{0.113f, 0.036f};
constexpr float kSlotExponent = 5.0f;
constexpr float kSlotFloor = 0.068f;
constexpr float kCrown = 0.182f;

Mesh placed(Mesh mesh, std::uint32_t material, const glm::mat4& transform) {
    mesh.setMaterial(material);
    Mesh result;
    result.append(mesh, transform);
    return result;
}

/// A point on the body's outline, seen from above at `angle` from straight ahead.
glm::vec3 onOutline(float degrees, float scale, float y) {
    const float angle = glm::radians(degrees);
    const float s = std::sin(angle);
    const float c = std::cos(angle);
    const float reach = std::pow(
        std::pow(std::abs(s) / kBodyHalf.x, kBodyExponent) + std::pow(std::abs(c) / kBodyHalf.y, kBodyExponent), -1.0f / kBodyExponent);
    return {s * reach * scale, y, c * reach * scale};
}

/// A tooth whose root reaches into the lip, so no gap shows.
Mesh tooth(float degrees, float scale, float y, float halfHeight) {
    return placed(chamferBox({-0.015f, -halfHeight, -0.008f}, {0.015f, halfHeight, 0.008f}, 0.005f), kEnamel,
        translation(onOutline(degrees, scale, y)) * rotation(degrees, {0, 1, 0}));
}

}  // namespace

Geometry makeJaw() {
    struct Step {
        float scale;
        float y;
        Slot slot;
    };
    const std::vector<Step> steps{{0.0f, -0.03f, kPaint}, {0.62f, -0.03f, kPaint}, {0.82f, -0.016f, kPaint}, {0.95f, 0.012f, kPaint},
        {1.0f, 0.05f, kPaint}, {1.0f, 0.074f, kChrome}, {1.045f, 0.08f, kChrome}, {1.05f, 0.092f, kChrome}, {1.02f, 0.099f, kChrome},
        {0.93f, 0.098f, kChrome}, {0.9f, 0.088f, kMouth}, {0.84f, 0.052f, kMouth}, {0.66f, 0.03f, kMouth}, {0.0f, 0.026f, kMouth}};
    std::vector<Ring> rings;
    rings.reserve(steps.size());
    for (const Step& step : steps) rings.push_back(superellipse(kBodyHalf * step.scale, kBodyExponent, step.y, kBodySegments));
    Mesh mesh = loft(rings, [&](std::size_t ring, std::size_t) { return steps[ring].slot; });

    for (float degrees : {-36.0f, -12.0f, 12.0f, 36.0f}) mesh.append(tooth(degrees, 0.955f, 0.106f, 0.016f));
    // The tongue.
    mesh.append(placed(sphere(1.0f, 10, 5), kMouth, translation({0, 0.034f, 0.05f}) * scaling({0.06f, 0.018f, 0.075f})));
    // The hinge barrel, held by the jaw.
    mesh.append(
        placed(cylinder(0.013f, 0.15f, 0.004f, 10), kBrass, translation(kHinge + glm::vec3(0.075f, 0, -0.022f)) * rotation(90, {0, 0, 1})));
    // The bearing the key turns in.
    mesh.append(placed(
        cylinder(0.024f, 0.03f, 0.006f, 12), kChrome, translation(kKeyBearing + glm::vec3(0, 0, 0.022f)) * rotation(-90, {1, 0, 0})));
    // The lever that would press the toast down.
    mesh.append(placed(
        chamferBox({-0.014f, -0.011f, -0.024f}, {0.018f, 0.011f, 0.024f}, 0.006f), kChrome, translation({kBodyHalf.x, 0.03f, 0.0f})));
    smoothNormals(mesh, 50.0f);
    return {mesh, {}, {}};
}

Geometry makeHead() {
    const glm::vec2 centre{0.0f, -kHinge.z};
    std::vector<Ring> rings;
    std::vector<Slot> slots;
    const auto add = [&](glm::vec2 half, float exponent, float y, Slot slot) {
        rings.push_back(superellipse(half, exponent, y, kBodySegments, centre));
        slots.push_back(slot);
    };
    // From the roof of the mouth outwards over the brim, up the dome and down into the slot.
    add(glm::vec2(0.0f), kBodyExponent, 0.034f, kMouth);
    add(kBodyHalf * 0.7f, kBodyExponent, 0.03f, kMouth);
    add(kBodyHalf * 0.91f, kBodyExponent, 0.0f, kChrome);
    add(kBodyHalf * 1.03f, kBodyExponent, -0.003f, kChrome);
    add(kBodyHalf * 1.055f, kBodyExponent, 0.006f, kChrome);
    add(kBodyHalf * 1.045f, kBodyExponent, 0.018f, kChrome);
    constexpr float kShoulder = 0.026f;
    constexpr int kDomeRings = 6;
    for (int i = 0; i < kDomeRings; ++i) {
        const float angle = glm::half_pi<float>() * static_cast<float>(i) / static_cast<float>(kDomeRings);
        const glm::vec2 half = kSlotLipHalf + (kBodyHalf - kSlotLipHalf) * std::cos(angle);
        const float exponent = glm::mix(kSlotExponent, kBodyExponent, std::cos(angle));
        add(half, exponent, kShoulder + (kCrown - 0.006f - kShoulder) * std::sin(angle), kPaint);
    }
    slots.back() = kChrome;
    add(kSlotLipHalf, kSlotExponent, kCrown - 0.004f, kChrome);
    add(kSlotLipHalf - 0.004f, kSlotExponent, kCrown, kChrome);
    add(kSlotHalf + 0.003f, kSlotExponent, kCrown, kChrome);
    add(kSlotHalf, kSlotExponent, kCrown - 0.004f, kMouth);
    add(kSlotHalf, kSlotExponent, kSlotFloor, kMouth);
    add(glm::vec2(0.0f), kSlotExponent, kSlotFloor, kMouth);
    Mesh mesh = loft(rings, [&](std::size_t ring, std::size_t) { return slots[ring]; });

    for (float side : {-1.0f, 1.0f}) {
        // A ring about each eye, square to the dome.
        const glm::vec3 outwards = glm::normalize(glm::vec3(side * 0.34f, 0.2f, 1.0f));
        const glm::mat4 frame = translation(glm::vec3(side * kEye.x, kEye.y, kEye.z) + outwards * 0.012f) * aimY(outwards);
        mesh.append(placed(torus(0.042f, 0.0085f, 12, 5), kChrome, frame));
    }
    for (float degrees : {-24.0f, 0.0f, 24.0f}) {
        Mesh upper = tooth(degrees, 0.955f, 0.0f, 0.014f);
        mesh.append(upper, translation({centre.x, -0.008f, centre.y}));
    }
    smoothNormals(mesh, 50.0f);
    return {mesh, {}, {}};
}

Geometry makeEye() {
    constexpr float kRadius = 0.042f;
    Profile profile{{0.0f, -kRadius}};
    // The pupil is its own cap, so that its edge is crisp.
    for (float degrees : {55.0f, 88.0f, 118.0f, 148.0f, 165.0f})
        profile.emplace_back(kRadius * std::sin(glm::radians(degrees)), -kRadius * std::cos(glm::radians(degrees)));
    profile.emplace_back(0.0f, kRadius);
    Mesh ball = lathe(profile, 12, [](std::size_t ring, std::size_t) { return ring >= 4 ? kPupil : kEnamel; });
    Mesh mesh;
    mesh.append(ball, rotation(90, {1, 0, 0}));
    smoothNormals(mesh, 80.0f);
    return {mesh, {}, {}};
}

Geometry makeKey() {
    Mesh mesh;
    const glm::mat4 backwards = rotation(-90, {1, 0, 0});
    mesh.append(placed(cylinder(0.009f, 0.07f, 0.002f, 8), kBrass, backwards));
    for (float side : {-1.0f, 1.0f}) mesh.append(placed(torus(0.034f, 0.0085f, 12, 5), kBrass, translation({side * 0.037f, 0, -0.083f})));
    mesh.append(placed(sphere(0.014f, 8, 4), kBrass, translation({0, 0, -0.083f})));
    smoothNormals(mesh, 50.0f);
    return {mesh, {}, {}};
}

}  // namespace obscura::toasters
