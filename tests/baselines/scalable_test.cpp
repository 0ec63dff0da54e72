// Scalable ambient obscurance against its published sum, evaluated on the CPU.
#include "baselines/baseline_test.h"

namespace obscura::test {
namespace {

class Scalable : public BaselineTest {
protected:
    Scalable() : BaselineTest("scalable") {}
};

// Only level 0 is exact. Coarser levels keep one of four depths; the bias has to hide the error.
TEST_F(Scalable, planesAreOpen) {
    for (const auto& world : planeWorlds()) EXPECT_LT(mean(run(depthFrameOf(world), values({}), "quadratic:1")), 0.01);
    const Room facing = depthFrameOf({{Kind::plane, {0, 0, -6}, {0, 0, 1}}});
    EXPECT_EQ(highest(run(facing, values({}), "quadratic:1")), 0.0f);
}

// The published estimator, integrated over the disc: samples lie at (i + 0.5)/s of the screen-space radius, evenly in angle.
TEST_F(Scalable, equalsThePublishedSumBesideAWall) {
    const Room room = depthFrameOf(floorAndWall());
    const double radius = 2.0 / 3.0 * 35.0 / 16.0, bias = 0.01;
    const Picture picture = run(room, values({{"samples", 100}, {"turns", 27}, {"denoise", 0}, {"sigma", 0.5f}}), "quadratic:1");
    int rows = 0;
    for (uint32_t y = room.guard; y < room.height - room.guard; ++y) {
        const glm::vec3 p = pointAt(room, 100, y);
        if (p.y > -1.49f || p.z > -4.0f || p.z < -4.9f) continue;
        const double perPixel = -p.z * 2.0 / double(std::abs(room.projection[5])) / room.height, reach = radius / perPixel;
        double expected = 0.0, found = 0.0;
        for (int i = 0; i < 100; ++i)
            for (int j = 0; j < 256; ++j) {
                const double l = (i + 0.5) / 100.0 * reach, angle = (j + 0.5) / 256.0 * 6.283185307;
                const int x = std::clamp(int(100 + int(l * std::cos(angle))), 0, int(room.width) - 1),
                          row = std::clamp(int(y) + int(l * std::sin(angle)), 0, int(room.height) - 1);
                const glm::dvec3 v = glm::dvec3(pointAt(room, uint32_t(x), uint32_t(row))) - glm::dvec3(p);
                const double vv = glm::dot(v, v), f = std::max(radius * radius - vv, 0.0);
                expected += f * f * f * std::max((v.y - bias) / (0.0025 * radius * radius + vv), 0.0) / 25600.0;
            }
        expected = std::min(expected * 5.0 * 0.5 / std::pow(radius, 6.0), 1.0);
        for (uint32_t x = 92; x < 108; ++x) found += picture[size_t(y - room.guard) * room.visibleWidth() + x - room.guard] / 16.0;
        EXPECT_NEAR(found, expected, 0.03) << "row " << y;
        rows += expected > 0.02;
    }
    EXPECT_GE(rows, 2);
}

TEST_F(Scalable, sigmaScalesObscurance) {
    const Room room = depthFrameOf(floorAndWall());
    const double once = mean(run(room, values({{"sigma", 0.1f}, {"denoise", 0}}), "quadratic:1")),
                 twice = mean(run(room, values({{"sigma", 0.2f}, {"denoise", 0}}), "quadratic:1"));
    EXPECT_NEAR(twice, 2.0 * once, 0.03 * once);
}

// The bilateral blur does not mix depths: a sheet 1 m in front of the wall stays open.
TEST_F(Scalable, blurStopsAtDepthEdges) {
    const Room room = depthFrameOf(
        {{Kind::plane, {0, 0, -6}, {0, 0, 1}}, {Kind::plane, {0, -1.5f, 0}, {0, 1, 0}}, {Kind::box, {0, 0, -3}, {0.8f, 3, 0.05f}}});
    const Picture raw = run(room, values({{"denoise", 0}}), "quadratic:1"), blurred = run(room, values({}), "quadratic:1");
    for (uint32_t x = 0; x < room.visibleWidth(); ++x)
        if (room.depth[size_t(40) * room.width + x + room.guard] < 3.5f && raw[size_t(20) * room.visibleWidth() + x] == 0.0f) {
            EXPECT_LT(blurred[size_t(20) * room.visibleWidth() + x], 0.05f) << x;
        }
}

}  // namespace
}  // namespace obscura::test
