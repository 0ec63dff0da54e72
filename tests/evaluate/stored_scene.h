// Runs obscura-evaluate on a stored scene, from triangles to voxels to visibility, against references ray-traced in the same geometry.
// Skips without the folder of references. Needs OBSCURA_EVALUATE.
#pragma once

#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "folders.h"
#include "gpu/test_device.h"
#include "shell.h"

namespace obscura::test {

// The rows that obscura-evaluate writes, one for each method; null if it failed. `options` as on the command line.
inline nlohmann::json evaluateStoredScene(const std::string& scene, const std::string& options) {
    const TemporaryFolder folder;
    const std::filesystem::path stem = oracleFolder() / scene;
    if (!std::filesystem::exists(stem.string() + ".glb")) skip("no " + stem.string() + ".glb; set OBSCURA_ORACLE to the stored references");
    const std::string command = shellCommand("{} --scene {} --camera scene:0 --size 320x180 --reference {} --frames 1 --json {} ",
                                    OBSCURA_EVALUATE, stem.string() + ".glb", stem.string() + ".reference.exr", folder / "rows.json") +
                                options;
    const Ended ended = runShell(command);
    EXPECT_EQ(ended.code, 0) << command << "\n" << ended.error;
    return ended.code == 0 ? nlohmann::json::parse(std::ifstream(folder / "rows.json")) : nlohmann::json();
}

}  // namespace obscura::test
