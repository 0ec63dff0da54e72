// Hemisphere SSAO against integrals of its published sample distribution.
#include "baselines/baseline_test.h"

namespace obscura::test {
namespace {

class Ssao : public BaselineTest {
protected:
    Ssao() : BaselineTest("ssao") {}
};

TEST_F(Ssao, planesAreOpen) {
    const Room wall = depthFrameOf({{Kind::plane, {0, 0, -6}, {0, 0, 1}}});
    for (const char* preset : {"default", "tuned"}) EXPECT_EQ(highest(run(wall, values({}, preset), "quadratic:1")), 0.0f) << preset;
}

// If directions are cosine-weighted and a fraction rho(d) of the sample points lies beyond distance d, the estimator integrates obscurance.
TEST_F(Ssao, tunedEqualsObscuranceBesideAWall) {
    const Room room = depthFrameOf(floorAndWall());
    ao::Falloff rho;
    ASSERT_TRUE(ao::parseFalloff("linear:1", rho));
    const std::vector<Row> rows = rowsBeforeWall(
        room, run(room, values({{"samples", 256}, {"radius_scale", 1}, {"bias", 0.002f}, {"denoise", 0}}, "tuned"), "linear:1"));
    ASSERT_GE(rows.size(), 3u);
    for (const Row& row : rows)
        EXPECT_NEAR(row.obscurance, beforeWall(row.away, true, [&](double d) { return double(ao::evaluate(rho, float(d))); }), 0.025)
            << row.away;
}

// Published sample points: uniform directions, at u mix(0.1, 1, v^2) of five times the falloff's mean length.
TEST_F(Ssao, defaultEqualsThePublishedIntegralBesideAWall) {
    const Room room = depthFrameOf(floorAndWall());
    const double radius = 5.0 * 0.5;  // linear:1 has a mean of 0.5 m
    const auto beyond = [&](double d) {
        double fraction = 0.0;
        for (int i = 0; i < 200; ++i) {
            const double v = (i + 0.5) / 200.0;
            fraction += std::max(0.0, 1.0 - d / (radius * (0.1 + 0.9 * v * v))) / 200.0;
        }
        return fraction;
    };
    const std::vector<Row> rows = rowsBeforeWall(room, run(room, values({{"samples", 256}, {"bias", 0.04f}, {"denoise", 0}}), "linear:1"));
    ASSERT_GE(rows.size(), 3u);
    for (const Row& row : rows)
        if (row.away > 0.3) {
            EXPECT_NEAR(row.obscurance, beforeWall(row.away, false, beyond), 0.035) << row.away;
        }
}

// An occluder far in front of the wall is faded out by the smoothstep range check.
TEST_F(Ssao, rangeCheckFadesFarOccluders) {
    const auto beside = [&](float z) {
        return mean(run(depthFrameOf({{Kind::plane, {0, 0, -20}, {0, 0, 1}}, {Kind::box, {0, 0, z}, {0.1f * -z, 3, 0.05f}}}), values({}),
            "quadratic:1"));
    };
    EXPECT_LT(beside(-3.0f), 0.5 * beside(-19.0f));
}

// Any 4x4 pixels contain all 16 rotations, so their mean has no tile pattern.
TEST_F(Ssao, blurRemovesTheTilePattern) {
    const Room room = depthFrameOf(floorAndWall());
    const auto roughness = [&](const Picture& picture) {
        double sum = 0.0;
        for (uint32_t y = 50; y < 60; ++y)
            for (uint32_t x = 60; x < 100; ++x)
                sum += std::fabs(picture[y * room.visibleWidth() + x] - picture[y * room.visibleWidth() + x + 1]);
        return sum / 400.0;
    };
    const Picture raw = run(room, values({{"samples", 16}, {"denoise", 0}}), "linear:1"),
                  blurred = run(room, values({{"samples", 16}}), "linear:1");
    EXPECT_LT(roughness(blurred), 0.25 * roughness(raw));
    EXPECT_NEAR(mean(blurred), mean(raw), 0.002);
}

}  // namespace
}  // namespace obscura::test
