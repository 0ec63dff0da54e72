// The stored analytic scenes end to end, from triangles to voxels to visibility, against references ray-traced in the same geometry.
// Skipped without the folder of references.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "../shell.h"

namespace {

namespace fs = std::filesystem;

void expectError(const std::string& scene, double most) {
    const char* named = std::getenv("OBSCURA_ORACLE");
    const fs::path folder = named && *named ? fs::path(named) : fs::path(OBSCURA_SOURCE_DIR) / ".." / "shared" / "oracle";
    if (!fs::exists(folder / (scene + ".glb")))
        GTEST_SKIP() << "no " << folder / (scene + ".glb") << "; set OBSCURA_ORACLE to the stored references";
    const fs::path result = fs::path(testing::TempDir()) / ("obscura-hybrid-" + scene + ".json");
    const std::string command = obscura::test::shellCommand(
        "{} --scene {} --camera scene:0 --size 320x180 --method hybrid --falloff wendland:2 --reference {} --channel world.wendland_2"
        " --frames 1 --warm-up 1 --json {}",
        OBSCURA_EVALUATE, folder / (scene + ".glb"), folder / (scene + ".reference.exr"), result);
    const obscura::test::Ended ended = obscura::test::runShell(command);
    ASSERT_EQ(ended.code, 0) << command << "\n" << ended.error;
    const nlohmann::json report = nlohmann::json::parse(std::ifstream(result));
    fs::remove(result);
    double eA = -1.0;
    const auto find = [&](const auto& self, const nlohmann::json& at) -> void {
        if (at.is_object() && at.contains("eA") && eA < 0.0) eA = at["eA"];
        if (at.is_structured())
            for (const auto& below : at) self(self, below);
    };
    find(find, report);
    ASSERT_GT(eA, 0.0) << report.dump();
    printf("hybrid %s wendland:2 world: eA %.4f\n", scene.c_str(), eA);
    EXPECT_LE(eA, most);
}

TEST(HybridOracle, cornerErrorIsBelowTheLimit) { expectError("corner", 0.015); }
TEST(HybridOracle, atriumErrorIsBelowTheLimit) { expectError("atrium", 0.029); }

}  // namespace
