// Temporal stability metrics on sequences with known results.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "truth/stability.h"

namespace {

using namespace obscura;
using namespace obscura::truth;

constexpr glm::uvec2 kVisible(64, 36), kGuard(8, 6);

// A wall at z = -2 m, optionally with a nearer strip in front of its middle.
struct Scene {
    glm::vec3 eye{0.0f};
    bool strip = false;
    CapturedFrame frame() const {
        scene::Camera camera;
        camera.eye = eye;
        camera.target = eye + glm::vec3(0, 0, -1);
        CapturedFrame out = emptyFrame(kVisible, kGuard, 1.0f, 0.05f, camera);
        out.normals.assign(out.depth.size(), {0, 0, 1});
        for (float& z : out.depth) z = 2.0f + eye.z;
        for (uint32_t y = 0; strip && y < out.size.y; ++y)
            for (uint32_t x = out.size.x / 2 - 6; x < out.size.x / 2 + 6; ++x) out.depth[out.index(x, y)] = 1.0f;
        return out;
    }
};

// Motion vectors of a resting world between two cameras.
std::vector<glm::vec2> motion(const CapturedFrame& now, const CapturedFrame& before) {
    std::vector<glm::vec2> out;
    for (uint32_t y = 0; y < now.size.y; ++y)
        for (uint32_t x = 0; x < now.size.x; ++x) {
            const glm::vec4 clip = before.projection * before.camera->view() * now.worldFromEye() * glm::vec4(now.eyePosition(x, y), 1.0f);
            out.push_back((glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(now.size) - glm::vec2(x, y) - 0.5f);
        }
    return out;
}

// A pattern fixed to the world.
Plane painted(const CapturedFrame& frame) {
    Plane plane(kVisible.x, kVisible.y);
    for (uint32_t y = 0; y < kVisible.y; ++y)
        for (uint32_t x = 0; x < kVisible.x; ++x) {
            const glm::vec3 p(frame.worldFromEye() * glm::vec4(frame.eyePosition(x + kGuard.x, y + kGuard.y), 1.0f));
            plane.at(x, y) = 0.5f + 0.2f * std::sin(3.0f * p.x) * std::cos(2.0f * p.y);
        }
    return plane;
}

Plane noisy(Plane plane, float deviation, uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> noise(0.0f, deviation);
    for (float& v : plane.values) v += noise(random);
    return plane;
}

TEST(Stability, patternFixedToTheWorldDoesNotFlicker) {
    const CapturedFrame before = Scene{{0, 0, 0}}.frame(), now = Scene{{0.13f, 0.02f, -0.1f}}.frame();
    const Correspondence way = correspond(now, before, motion(now, before));
    EXPECT_GT(way.share(), 0.85f);
    const Change still = change(way, painted(now), painted(before), {painted(now), {}}, {painted(before), {}});
    EXPECT_LT(still.difference, 0.002f);
    EXPECT_NEAR(still.excess(), 0.0f, 1e-4f);
    EXPECT_NEAR(still.flickerOfError, 0.0f, 1e-6f);
    // Compared without motion vectors, the same images differ.
    const Correspondence inPlace = correspond(before, before, std::vector<glm::vec2>(before.depth.size(), glm::vec2(0)));
    EXPECT_GT(change(inPlace, painted(now), painted(before), {painted(before), {}}, {painted(before), {}}).difference, 0.02f);
}

// Grooves narrower than a pixel appear and vanish with its centre, so they do not correspond to the wall around them.
TEST(Stability, groovesAreOtherSurfaces) {
    const CapturedFrame before = Scene{}.frame();
    const std::vector<glm::vec2> still(before.depth.size(), glm::vec2(0));
    const float pixel = 2.0f / before.view().pixelsPerMetre;  // width of a pixel on the wall, metres
    const auto share = [&](float deep) {
        CapturedFrame now = before;
        for (size_t i = 0; i < now.depth.size(); i += 2) now.depth[i] += deep * pixel;
        return correspond(now, before, still).share();
    };
    EXPECT_EQ(share(0.04f), 1.0f);
    EXPECT_NEAR(share(0.07f), 0.5f, 0.01f);
}

TEST(Stability, noiseOfKnownDeviationIsMeasured) {
    const CapturedFrame frame = Scene{}.frame();
    const Correspondence way = correspond(frame, frame, std::vector<glm::vec2>(frame.depth.size(), glm::vec2(0)));
    EXPECT_EQ(way.share(), 1.0f);
    const Plane truth = painted(frame);
    const Change c = change(way, noisy(truth, 0.05f, 1), noisy(truth, 0.05f, 2), {truth, {}}, {truth, {}});
    const float both = 0.05f * std::sqrt(2.0f);
    EXPECT_NEAR(c.flickerOfError, both, 0.003f);
    EXPECT_NEAR(c.difference, both * std::sqrt(2.0f / 3.14159265f), 0.003f);  // mean of a half normal
    EXPECT_EQ(c.referenceDifference, 0.0f);
}

TEST(Stability, changeOfTheReferenceIsNotFlicker) {
    const CapturedFrame frame = Scene{}.frame();
    const Correspondence way = correspond(frame, frame, std::vector<glm::vec2>(frame.depth.size(), glm::vec2(0)));
    const Plane dark(kVisible.x, kVisible.y, 0.3f), light(kVisible.x, kVisible.y, 0.8f);
    const Change c = change(way, light, dark, {light, {}}, {dark, {}});
    EXPECT_NEAR(c.difference, 0.5f, 1e-5f);
    EXPECT_NEAR(c.excess(), 0.0f, 1e-6f);
    EXPECT_NEAR(c.flickerOfError, 0.0f, 1e-6f);
}

// Noise of a reference with few rays must not count as flicker of the method.
TEST(Stability, noiseOfTheReferenceIsSubtracted) {
    const CapturedFrame frame = Scene{}.frame();
    const Correspondence way = correspond(frame, frame, std::vector<glm::vec2>(frame.depth.size(), glm::vec2(0.3f, 0.4f)));
    const Plane truth(kVisible.x, kVisible.y, 0.6f), error(kVisible.x, kVisible.y, 0.04f);
    const auto traced = [&](uint32_t seed) { return Traced{noisy(truth, 0.04f, seed), error}; };
    const Change still = change(way, truth, truth, traced(1), traced(2));
    EXPECT_LT(still.flickerOfError, 0.012f);       // 0.05 if it counted
    EXPECT_LT(still.referenceDifference, 0.016f);  // 0.04
    const Change flickering = change(way, noisy(truth, 0.05f, 3), truth, traced(1), traced(2));
    EXPECT_NEAR(flickering.flickerOfError, 0.05f, 0.004f);
}

TEST(Stability, disocclusionsAreExcluded) {
    const CapturedFrame before = Scene{{0, 0, 0}, true}.frame(), now = Scene{{0, 0, 0}, false}.frame();
    const Correspondence way = correspond(now, before, std::vector<glm::vec2>(now.depth.size(), glm::vec2(0)));
    for (uint32_t x = 0; x < kVisible.x; ++x) {
        const bool behind = x >= kVisible.x / 2 - 6 && x < kVisible.x / 2 + 6;
        EXPECT_EQ(way.same[10 * kVisible.x + x], !behind) << x;
        EXPECT_EQ(way.disoccluded[10 * kVisible.x + x], behind) << x;
    }
    const Mask mask = stayed(before, now);
    EXPECT_FALSE(mask[10 * kVisible.x + kVisible.x / 2]);
    EXPECT_TRUE(mask[10 * kVisible.x + 3]);
}

TEST(Stability, staticNoiseIsTheDeviationOfEachPixel) {
    StaticNoise none, some;
    for (uint32_t t = 0; t < 64; ++t) {
        none.add(Plane(32, 32, 0.7f));
        some.add(noisy(Plane(32, 32, 0.7f), 0.02f, t));
    }
    EXPECT_EQ(none.over({}).mean, 0.0f);
    EXPECT_EQ(none.over({}).p99, 0.0f);
    EXPECT_NEAR(some.over({}).mean, 0.02f, 0.001f);
    EXPECT_GT(some.over({}).p99, 0.022f);
    EXPECT_EQ(some.over(Mask(32 * 32, 0)).mean, 0.0f);
}

TEST(Stability, lagCountsFramesUntilNineTenths) {
    const Plane dark(16, 16, 0.4f), light(16, 16, 1.0f);
    const Mask all(16 * 16, 1);
    const auto fading = [&](float kept) {  // `kept`: fraction of the old state left after each frame
        std::vector<Plane> after;
        float left = 1.0f;
        for (int t = 0; t < 200; ++t) {
            left *= kept;
            after.push_back(Plane(16, 16, 1.0f - 0.6f * left));
        }
        return after;
    };
    EXPECT_EQ(lag(dark, fading(0.0f), dark, light, all).t90, 1u);
    EXPECT_EQ(lag(dark, fading(0.0f), dark, light, all).ghost, 0.0f);
    const Lag half = lag(dark, fading(0.5f), dark, light, all);
    EXPECT_EQ(half.t90, 4u);  // 0.5, 0.25, 0.125, 0.0625
    EXPECT_NEAR(half.ghost, 0.6f, 1e-3f);
    EXPECT_EQ(lag(dark, fading(0.9f), dark, light, all).t90, 22u);
    EXPECT_EQ(lag(dark, fading(0.9f), dark, light, Mask(16 * 16, 0)).pixels, 0u);
    EXPECT_EQ(lag(dark, fading(0.9f), dark, dark, all).t90, 0u);
}

}  // namespace
