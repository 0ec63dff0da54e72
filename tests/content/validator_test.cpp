// Holds the written files against the Khronos validator, where node and its package are at hand.
#include "content_helpers.h"
#include "meshkit/file_output.h"
#include "meshkit/glb_writer.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <sys/wait.h>

namespace obscura::content {

namespace {

struct Outcome {
    int exitCode = 0;
    std::string output;
};

Outcome run(const std::string& command)
{
    Outcome outcome;
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 512> buffer;
    while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr)
        outcome.output += buffer.data();
    const int status = pclose(pipe);
    outcome.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
}

void expectClean(const kit::Scene& scene)
{
    if (run("node --version 2>/dev/null").exitCode != 0)
        GTEST_SKIP() << "node is not installed";
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("obscura-validator-" + scene.name + ".glb");
    kit::writeFile(file, kit::writeGlb(scene));
    const Outcome outcome = run("node '" OBSCURA_VALIDATOR_SCRIPT "' '" + file.string() + "'");
    std::filesystem::remove(file);
    constexpr int kNoPackage = 3;
    if (outcome.exitCode == kNoPackage)
        GTEST_SKIP() << "the npm package gltf-validator was not found; name its node_modules folder in "
                        "OBSCURA_GLTF_VALIDATOR or NODE_PATH";
    EXPECT_EQ(outcome.exitCode, 0) << outcome.output;
    EXPECT_EQ(outcome.output, "0 0\n");
}

} // namespace

TEST(Validator, FindsNothingWrongWithTheToasters)
{
    expectClean(toasters());
}

TEST(Validator, FindsNothingWrongWithTheAtrium)
{
    expectClean(atrium());
}

} // namespace obscura::content
