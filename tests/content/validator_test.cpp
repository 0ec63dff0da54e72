// Validates the written files with the Khronos glTF validator, if node and its package are installed.
#include "../shell.h"
#include "content_helpers.h"
#include "meshkit/file_output.h"
#include "meshkit/glb_writer.h"

#include <gtest/gtest.h>
#include <filesystem>
#include <string>

namespace obscura::content {

namespace {

void expectClean(const kit::Scene& scene) {
    if (test::runShell("node --version").code != 0) GTEST_SKIP() << "node is not installed";
    const std::filesystem::path file = std::filesystem::temp_directory_path() / ("obscura-validator-" + scene.name + ".glb");
    kit::writeFile(file, kit::writeGlb(scene));
    const test::Ended ended = test::runShell(test::shellCommand("node {} {}", OBSCURA_VALIDATOR_SCRIPT, file));
    std::filesystem::remove(file);
    constexpr int kNoPackage = 3;
    if (ended.code == kNoPackage)
        GTEST_SKIP() << "the npm package gltf-validator was not found; name its node_modules folder in "
                        "OBSCURA_GLTF_VALIDATOR or NODE_PATH";
    EXPECT_EQ(ended.code, 0) << ended.out << ended.error;
    EXPECT_EQ(ended.out, "0 0\n");
}

}  // namespace

TEST(Validator, AcceptsTheToasters) { expectClean(toasters()); }

TEST(Validator, AcceptsTheAtrium) { expectClean(atrium()); }

}  // namespace obscura::content
