// Volumetric obscurance against closed forms beside a wall.
#include "baselines/baseline_test.h"

namespace obscura::test {
namespace {

class Volumetric : public BaselineTest {
protected:
    Volumetric() : BaselineTest("volumetric") {}
};

TEST_F(Volumetric, planesAreOpen) {  // the whole sphere is tested only facing the camera: its value depends on the lines
    for (const auto& world : planeWorlds())
        for (const float solid : {1.0f, 2.0f}) {
            const Picture picture = run(depthFrameOf(world), values({{"solid", solid}}), "quadratic:1");
            EXPECT_LT(mean(picture), 1e-3) << solid;
            EXPECT_LT(highest(picture), 0.05f) << solid;  // where a pixel is wider than the sphere
        }
    const Room facing = depthFrameOf({{Kind::plane, {0, 0, -6}, {0, 0, 1}}});
    EXPECT_LT(mean(run(facing, values({{"solid", 0}, {"lines", 64}}), "quadratic:1")), 0.01);
}

// A wall at h radii from the centre cuts a cap of (2 - 3 h + h^3) / 4 of the sphere's volume. Half of the cap is above the floor, so the
// hemisphere loses the same fraction; the sphere that touches the floor as well.
TEST_F(Volumetric, equalsTheSphericalCapBesideAWall) {
    const Room room = depthFrameOf(floorAndWall());
    for (const float solid : {1.0f, 2.0f}) {
        const double radius = 2.0 / 3.0 / (solid == 1.0f ? 0.75 : 1.2);  // quadratic:1 has a mean of 2/3 m
        const std::vector<Row> rows =
            rowsBeforeWall(room, run(room, values({{"solid", solid}, {"lines", 64}, {"denoise", 0}}), "quadratic:1"));
        ASSERT_GE(rows.size(), 3u);
        for (const Row& row : rows) {
            const double h = std::min(row.away / radius, 1.0);
            EXPECT_NEAR(row.obscurance, (2.0 - 3.0 * h + h * h * h) / 4.0, 0.03) << solid << ": " << row.away;
        }
    }
}

TEST_F(Volumetric, lightPassesBehindThinOccluders) {
    const Room room = depthFrameOf({{Kind::plane, {0, 0, -6}, {0, 0, 1}}, {Kind::box, {0, 0, -4}, {0.2f, 3, 0.1f}}});
    EXPECT_LT(mean(run(room, values({{"thickness", 0.1f}}), "constant:3")), 0.5 * mean(run(room, values({}), "constant:3")));
}

}  // namespace
}  // namespace obscura::test
