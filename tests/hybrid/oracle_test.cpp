// The stored analytic scenes end to end, from triangles to voxels to visibility, against references ray-traced in the same geometry.
// Skipped without the folder of references.
#include "evaluate/stored_scene.h"

namespace obscura::test {
namespace {

void expectError(const std::string& scene, double most) {
    const nlohmann::json rows = evaluateStoredScene(scene, "--method hybrid --falloff wendland:2 --channel world.wendland_2 --warm-up 1");
    ASSERT_EQ(rows.size(), 1u);
    const double eA = rows[0].at("eA");
    ASSERT_GT(eA, 0.0) << rows.dump();
    printf("hybrid %s wendland:2 world: eA %.4f\n", scene.c_str(), eA);
    EXPECT_LE(eA, most);
}

TEST(HybridOracle, cornerErrorIsBelowTheLimit) { expectError("corner", 0.015); }
TEST(HybridOracle, atriumErrorIsBelowTheLimit) { expectError("atrium", 0.029); }

}  // namespace
}  // namespace obscura::test
