// Visibility bitmasks against integrals beside a wall.
#include "baselines/baseline_test.h"

namespace obscura::test {
namespace {

class VisibilityBitmask : public BaselineTest {
protected:
    VisibilityBitmask() : BaselineTest("visibility_bitmask") {}
};

TEST_F(VisibilityBitmask, equalWeightSectorsLeavePlanesOpen) {
    for (const auto& world : planeWorlds()) {
        EXPECT_LT(highest(run(depthFrameOf(world), values({{"mip_offset", 30}}, "tuned"), "ramp:0.385:1")), 0.5f / 255.0f);
        EXPECT_LT(
            mean(run(depthFrameOf(world), values({}, "tuned"), "ramp:0.385:1")), 0.005);  // coarser depths deviate slightly from the plane
    }
}

// With infinite thickness, sectors of equal cosine weight integrate obscurance.
TEST_F(VisibilityBitmask, equalWeightSectorsEqualObscuranceBesideAWall) {
    const Room room = depthFrameOf(floorAndWall());
    ao::Falloff rho;
    ASSERT_TRUE(ao::parseFalloff("ramp:0.385:1", rho));
    const Changes fine = {{"slices", 16}, {"steps", 32}, {"mip_offset", 30}, {"thickness", 1000}, {"denoise", 0}};
    const std::vector<Row> rows = rowsBeforeWall(room, run(room, values(fine, "tuned"), "ramp:0.385:1"));
    ASSERT_GE(rows.size(), 3u);
    for (const Row& row : rows)
        EXPECT_NEAR(row.obscurance, beforeWall(row.away, true, [&](double d) { return double(ao::evaluate(rho, float(d))); }), 0.015)
            << row.away;
}

// As published, the covered fraction of each slice's angle, integrated. Outside the image its edge texels repeat, so the wall is infinite.
// A sector that is touched counts as covered, so the floor covers the outermost sector on either side: 2/32 too much.
TEST_F(VisibilityBitmask, equalAngleSectorsEqualThePublishedIntegralBesideAWall) {
    const Room room = depthFrameOf(floorAndWall());
    const std::vector<Row> rows = rowsBeforeWall(
        room, run(room, values({{"slices", 16}, {"steps", 32}, {"mip_offset", 30}, {"thickness", 1000}, {"denoise", 0}, {"axis", 1}}),
                  "constant:50"));
    ASSERT_GE(rows.size(), 3u);
    for (const Row& row : rows) {
        const glm::dvec3 p(0, -1.5, -5.0 + row.away),
            v = glm::normalize(-p), n(0, 1, 0), tangent = glm::normalize(glm::dvec3(1, 0, 0) - v * v.x), other = glm::cross(tangent, v);
        int blocked = 0, all = 0;
        for (int k = 0; k < 180; ++k) {
            const double turn = (k + 0.5) / 180.0 * 3.14159265;
            const glm::dvec3 across = tangent * std::cos(turn) + other * std::sin(turn);
            for (int j = 0; j < 360; ++j) {
                const double angle = (j + 0.5) / 360.0 * 6.283185307;
                const glm::dvec3 d = v * std::cos(angle) + across * std::sin(angle);
                if (glm::dot(d, n) <= 0.0) continue;
                ++all;
                blocked += d.z < 0.0;
            }
        }
        EXPECT_NEAR(row.obscurance, double(blocked) / all + 2.0 / 32.0, 0.015) << row.away;
    }
}

// With a small thickness light passes behind a post; with 1000 m it does not.
TEST_F(VisibilityBitmask, lightPassesBehindThinOccluders) {
    const Room room = depthFrameOf({{Kind::plane, {0, 0, -6}, {0, 0, 1}}, {Kind::box, {0, 0, -4}, {0.2f, 3, 0.1f}}});
    for (const char* preset : {"default", "tuned"}) {
        const double thin = mean(run(room, values({{"thickness", 0.1f}}, preset), "constant:4")),
                     thick = mean(run(room, values({{"thickness", 1000}}, preset), "constant:4"));
        EXPECT_LT(thin, 0.7 * thick) << preset;
        EXPECT_GT(thin, 0.0) << preset;
    }
}

}  // namespace
}  // namespace obscura::test
