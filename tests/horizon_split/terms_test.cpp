// The two terms separately: a plane is open, a known horizon has its exact value, the sum is at most the hemisphere.
#include <random>

#include "horizon_split/fixture.h"

namespace obscura::test {
namespace {

class Planes : public HorizonSplitTest, public testing::WithParamInterface<std::array<float, 3>> {};
INSTANTIATE_TEST_SUITE_P(Terms, Planes, testing::Values(std::array{0.0f, 1.0f, 0.0f}, std::array{0.5f, 1.0f, 0.05f}));

TEST_P(Planes, areExactlyOpen) {
    const Room room = plane(GetParam());
    EXPECT_LT(highest(run(room, values({}))), 1e-6f);
    EXPECT_LT(highest(run(room, values({}, "quality"))), 1e-6f);
    // Texel centres lie on the plane, so horizons do not rise even without the offset; rays do hit the steps between texels.
    EXPECT_LT(highest(run(room, values({{"offset", 0}, {"normal_rays", 0}}))), 1e-6f);
    EXPECT_GT(mean(run(room, values({{"offset", 0}, {"term", kNormalRays}, {"thickness", 100}}))), 0.1);
}

// A pixel at the bottom of a hole 1 px wide, under a plate `height` above its start, orthographic, 1 mm per px.
// With constant falloff, no jitter and first steps at `kFirst`, the horizon in every direction is the plate at the first step.
constexpr float kPixel = 0.001f, kFirst = 0.02f;
constexpr uint32_t kSteps = 3;  // kRadius / kSteps / 2 is kFirst
const char* const kFalloff = "constant:0.12";

Room hole(float height) {
    Room room;
    room.width = room.height = 321;
    room.guard = 160;
    room.build();
    const float scale = 2.0f / (float(room.width) * kPixel);
    const float orthographic[16] = {scale, 0, 0, 0, 0, -scale, 0, 0, 0, 0, -0.01f, 0, 0, 0, 0, 1};
    std::memcpy(room.projection, orthographic, sizeof(orthographic));
    std::fill(room.depth.begin(), room.depth.end(), 2.0f - kPixel - height);
    room.depth[160 * 321 + 160] = 2.0f;
    for (size_t i = 0; i < room.depth.size(); ++i) {
        room.normals[4 * i + 1] = 0.0f;
        room.normals[4 * i + 2] = 1.0f;
    }
    return room;
}

class UnderAPlate : public HorizonSplitTest {
protected:
    // One term at the bottom of the hole; by default infinite thickness and even steps, replaced by `changes`.
    float at(float height, Term term, const Changes& changes) {
        Changes all = {{"steps", kSteps}, {"jitter", 0}, {"spacing", 0}, {"thickness", 100}, {"horizon_thickness", 100}, {"blur", 0},
            {"term", float(term)}};
        all.insert(all.end(), changes.begin(), changes.end());
        const Picture picture = run(hole(height), values(all), kFalloff);
        EXPECT_EQ(picture.size(), 1u);
        return picture.at(0);
    }
};

TEST_F(UnderAPlate, horizonTermIsTheSquaredSine) {
    // The sine of the plate's elevation at the first step is 0.6. Later steps pass in front of the plate.
    for (const float directions : {1.0f, 4.0f, 7.0f, 8.0f, 24.0f})
        EXPECT_NEAR(at(0.75f * kFirst, kHorizon, {{"directions", directions}}), 0.36f, 0.02f) << directions;
}

TEST_F(UnderAPlate, raysDivideTheRangeAboveTheHorizon) {
    // Above a horizon of 0.6 four rays represent the intervals .36 - .52 - .68 - .84 - 1 of the hemisphere, .16 each. The plate
    // blocks rays with a sine below 0.75, squared .5625: all of the first, a quarter of the second, none of the others.
    EXPECT_NEAR(at(0.75f * kFirst, kNormalRays, {{"directions", 24}, {"normal_rays", 4}}), 0.16f + (0.5625f - 0.52f), 0.02f);
}

TEST_F(UnderAPlate, blockedHemisphereIsOne) {
    const float height = 1.2f * kFirst;  // H^2 = 1.44 / 2.44, and every ray meets the plate
    for (const float directions : {3.0f, 8.0f, 17.0f}) {
        for (const float rays : {1.0f, 4.0f}) {
            const Changes changes = {{"directions", directions}, {"normal_rays", rays}};
            EXPECT_NEAR(at(height, kHorizon, changes), 0.59f, 0.03f);
            EXPECT_NEAR(at(height, kHorizon, changes) + at(height, kNormalRays, changes), 1.0f, 0.006f)
                << directions << " directions, " << rays << " rays";
            EXPECT_GT(at(height, kBoth, changes), 0.994f);
        }
    }
}

TEST_F(UnderAPlate, linesFarBehindASurfaceAreNotBlocked) {
    // Lines pass behind the plate by at most its height, 0.2 radii.
    const float height = 1.2f * kFirst;
    EXPECT_GT(at(height, kNormalRays, {{"thickness", 0.25f}}), 0.35f);
    EXPECT_EQ(at(height, kNormalRays, {{"thickness", 0.01f}}), 0.0f);
    EXPECT_GT(at(height, kHorizon, {{"horizon_thickness", 0.25f}}), 0.5f);
    EXPECT_EQ(at(height, kHorizon, {{"horizon_thickness", 0.01f}}), 0.0f);
}

TEST_F(HorizonSplitTest, randomDepthsGiveAtMostTheHemisphere) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> depths(2.0f, 3.0f), components(-1.0f, 1.0f);
    Room room;
    room.build();
    for (float& z : room.depth) z = depths(random);
    for (float& n : room.normals) n = components(random);
    for (const char* falloff : {"constant:1", "linear:1.5", "exponential:0.3"}) {
        const Picture both = run(room, values({{"normal_rays", 2}, {"blur", 0}}), falloff);
        const Picture horizon = run(room, values({{"blur", 0}, {"term", kHorizon}}), falloff);
        const Picture rays = run(room, values({{"normal_rays", 2}, {"blur", 0}, {"term", kNormalRays}}), falloff);
        for (size_t i = 0; i < both.size(); ++i) {
            ASSERT_GE(horizon[i], 0.0f);
            ASSERT_GE(rays[i], 0.0f);
            ASSERT_LE(horizon[i] + rays[i], 1.001f) << falloff << " pixel " << i;
            ASSERT_NEAR(horizon[i] + rays[i], both[i], 0.002f) << falloff << " pixel " << i;  // half floats
        }
        EXPECT_GT(mean(both), 0.2) << falloff;
    }
}

TEST_F(HorizonSplitTest, horizonsAndRaysAreSeparatePasses) {
    Room room;
    room.wall = -4.0f;
    room.build();
    run(room, values({}));
    for (const char* pass : {"horizon_split.horizons", "horizon_split.normal rays", "horizon_split.blur"})
        EXPECT_TRUE(m_passes.count(pass)) << pass;
    run(room, values({}, "paper_fast"));
    EXPECT_FALSE(m_passes.count("horizon_split.normal rays"));
    run(room, values({{"blur", 0}}));
    EXPECT_FALSE(m_passes.count("horizon_split.blur"));
}

// A plate 330 radii before the bottom of a hole.
TEST_F(HorizonSplitTest, endlessThicknessHasNoEnd) {
    Room room = hole(0.0f);
    std::fill(room.depth.begin(), room.depth.end(), 10.0f);
    room.depth[160 * 321 + 160] = 50.0f;
    const auto at = [&](const char* preset, float thickness) {
        return run(room, values({{"thickness", thickness}, {"term", kMarching}, {"blur", 0}}, preset), kFalloff).at(0);
    };
    EXPECT_GT(at("paper", 100), 0.9f);
    EXPECT_LT(at("paper", 99), 0.1f);
}

// Depth layers give surfaces their thickness for normal rays through the depth buffer alone; asked for without such rays, a warning says
// so.
TEST_F(HorizonSplitTest, depthLayersWithoutNormalRaysAreLogged) {
    Room room;
    room.build();
    const auto warns = [&](const Changes& changes) {
        logged().clear();
        run(room, values(changes));
        return loggedContains("horizon_split: depth_layers ");
    };
    EXPECT_FALSE(warns({{"normal_rays", 0}}));
    EXPECT_FALSE(warns({{"depth_layers", 3}}));
    EXPECT_FALSE(warns({{"depth_layers", 3}, {"normal_rays", 0}, {"term", kMarching}}));
    EXPECT_TRUE(warns({{"depth_layers", 3}, {"normal_rays", 0}}));
    EXPECT_FALSE(warns({{"depth_layers", 3}, {"normal_rays", 0}})) << "once is enough";
    m_library = std::make_unique<ao::Library>(m_device, m_shaders);
    EXPECT_TRUE(warns({{"depth_layers", 3}, {"rays_in", 1}}));
}

}  // namespace
}  // namespace obscura::test
