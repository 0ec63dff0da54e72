// The preset `tuned`, which sums arcs of single samples: planes and convex solids are open, and the value beside a wall is exact.
#include "ao/solids.h"

namespace obscura::test {
namespace {

class Terms : public MethodTest {
protected:
    Terms() : MethodTest("gtao") {}
};

TEST_F(Terms, arcsLeaveConvexSolidsOpen) {
    const auto worlds = convexWorlds();
    for (size_t i = 0; i < worlds.size(); ++i) {
        EXPECT_LT(highest(run(depthFrameOf(worlds[i]), values({{"mip_offset", 30}}, "tuned"), "ramp:0.385:1")), 0.5f / 255.0f)
            << "world " << i;
        EXPECT_LT(mean(run(depthFrameOf(worlds[i]), values({}, "tuned"), "ramp:0.385:1")), 0.001)
            << "world " << i;  // coarser depths deviate slightly from the plane
    }
    // The published horizon does obscure a bare floor: the nearest texels raise it.
    EXPECT_GT(mean(run(depthFrameOf(worlds[0]), values({}), "ramp:0.385:1")), 0.001);
}

// A floor before a wall against ray-traced obscurance: slices around the view ray cover the hemisphere.
TEST_F(Terms, arcsMatchTheReferenceBesideAWall) {
    const std::vector<Solid> world = floorAndWall();
    const Room room = depthFrameOf(world);
    ao::Falloff rho;
    ASSERT_TRUE(ao::parseFalloff("ramp:0.385:1", rho));
    const Picture fine =
        run(room, values({{"slices", 16}, {"steps", 32}, {"mip_offset", 30}, {"denoise", 0}, {"radius_scale", 1}, {"power", 1}}, "tuned"),
            "ramp:0.385:1");
    int compared = 0;
    for (uint32_t y = room.guard; y < room.height - room.guard; ++y) {
        double found = 0.0, expected = 0.0;
        for (uint32_t x = 60; x < 140; x += 10) {
            const glm::vec3 p = pointAt(room, x, y);
            if (p.y > -1.49f || p.z < -4.9f || p.z > -4.2f) continue;
            found += fine[size_t(y - room.guard) * room.visibleWidth() + x - room.guard] / 8.0;
            expected += worldObscurance(world, p, {0, 1, 0}, rho, 1024) / 8.0;
        }
        compared += expected > 0.02;
        EXPECT_NEAR(found, expected, 0.012) << "row " << y;
    }
    EXPECT_GE(compared, 2);
}

TEST_F(Terms, largerRadiusScaleDarkens) {
    const Room room = depthFrameOf(floorAndWall());
    for (const char* preset : {"default", "tuned"}) {
        const double once = mean(run(room, values({{"radius_scale", 1}}, preset), "quadratic:1")),
                     twice = mean(run(room, values({{"radius_scale", 2}}, preset), "quadratic:1"));
        EXPECT_GT(twice, 1.2 * once) << preset;
        // A falloff of twice the length has the same effect.
        EXPECT_NEAR(mean(run(room, values({{"radius_scale", 1}}, preset), "quadratic:2")), twice, 1e-4) << preset;
    }
}

}  // namespace
}  // namespace obscura::test
