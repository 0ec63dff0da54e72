// The stored analytic scenes end to end, from triangles to voxels to visibility, against references ray-traced in the world: off-screen
// occluders increase no method's error. Skipped without the folder of references.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "../shell.h"

namespace {

namespace fs = std::filesystem;

struct Error {
    double eA = -1.0, bias = 0.0;
};

// Errors by method; `settings` as on the command line.
std::map<std::string, Error> errors(const fs::path& folder, const std::string& scene, const std::string& settings) {
    const fs::path result = fs::path(testing::TempDir()) / ("obscura-offscreen-" + scene + ".json");
    const std::string command =
        obscura::test::shellCommand(
            "{} --scene {} --camera scene:0 --size 320x180 --falloff quadratic:2 --reference {} --channel world.quadratic_2"
            " --frames 1 --warm-up 0 --json {} ",
            OBSCURA_EVALUATE, folder / (scene + ".glb"), folder / (scene + ".reference.exr"), result) +
        settings;
    const obscura::test::Ended ended = obscura::test::runShell(command);
    EXPECT_EQ(ended.code, 0) << command << "\n" << ended.error;
    std::map<std::string, Error> list;
    for (const nlohmann::json& row : nlohmann::json::parse(std::ifstream(result))) list[row.at("method")] = {row.at("eA"), row.at("bias")};
    fs::remove(result);
    return list;
}

void expectNoWorse(const std::string& scene) {
    const char* named = std::getenv("OBSCURA_ORACLE");
    const fs::path folder = named && *named ? fs::path(named) : fs::path(OBSCURA_SOURCE_DIR) / ".." / "shared" / "oracle";
    if (!fs::exists(folder / (scene + ".glb")))
        GTEST_SKIP() << "no " << folder / (scene + ".glb") << "; set OBSCURA_ORACLE to the stored references";
    const std::string methods =
        "--method hbao,multi_resolution,horizon_split,statistical,far_field --set far_field.thickness=0.1 --set far_field.averaging=none";
    const auto alone = errors(folder, scene, methods), hidden = errors(folder, scene, methods + " --offscreen hidden");
    ASSERT_EQ(alone.size(), 5u);
    for (const auto& [method, error] : alone) {
        const Error& both = hidden.at(method);
        printf(
            "%-7s %-17s quadratic:2 world: eA %.4f alone, %.4f with hidden occluders\n", scene.c_str(), method.c_str(), error.eA, both.eA);
        EXPECT_LE(both.eA, error.eA) << method;
        // In the corner nearly all occluders are visible, so little may be added.
        if (scene == "corner" && method != "far_field") {
            EXPECT_LT(error.bias - both.bias, 0.0015) << method;
        }
        EXPECT_GE(error.bias - both.bias, 0.0) << method;
    }
}

TEST(OffScreenOracle, cornerIsNoWorse) { expectNoWorse("corner"); }
TEST(OffScreenOracle, atriumIsNoWorse) { expectNoWorse("atrium"); }

}  // namespace
