// Each method's visibility of the toasters, and the final image, against reviewed images. The fraction of pixels that may differ by more
// than a tolerance depends on the driver; the figures of each image are printed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#define STB_IMAGE_IMPLEMENTATION
#include <stb_image.h>

#include "../shell.h"
#include "obscura/ao.h"

namespace {

namespace fs = std::filesystem;
const fs::path kFolder = fs::path(OBSCURA_SOURCE_DIR) / "tests" / "golden";

// Limits by driver, selected by the prefix of the device name: this fraction of the pixels may differ by more than `tolerance`.
struct Family {
    const char* name;
    int tolerance;    // of 255
    double outliers;  // fraction of the pixels
};
constexpr Family kFamilies[] = {
    {"llvmpipe", 5, 0.001},    // made the golden images; LLVM 15 and 19 round differently
    {"SwiftShader", 5, 0.01},  // rounds differently: some pixels at silhouettes take another sample
    {"", 5, 0.02},             // others, such as GPUs: texture filtering and fused multiply-add differ as well
};
const Family& familyOf(const std::string& output) {
    for (const Family& family : kFamilies)
        if (output.find(family.name) != output.npos) return family;
    return kFamilies[std::size(kFamilies) - 1];
}

struct Pixels {
    int width = 0, height = 0;
    std::unique_ptr<stbi_uc, void (*)(void*)> rgb{nullptr, stbi_image_free};
    explicit Pixels(const fs::path& file) {
        int channels = 0;
        rgb.reset(stbi_load(file.c_str(), &width, &height, &channels, 3));
    }
};

void check(const std::string& method, const std::string& view) {
    const fs::path golden = kFolder / (method + "." + view + ".png");
    const fs::path made = fs::path(testing::TempDir()) / ("obscura-golden-" + method + "-" + view + ".png");
    const char* renewed = std::getenv("OBSCURA_RENEW_GOLDEN");  // methods, with commas, or "all"
    std::istringstream list(renewed ? renewed : "");
    bool renew = false;
    for (std::string one; std::getline(list, one, ',');) renew = renew || one == method || one == "all";
    const fs::path target = renew ? golden : made;
    fs::remove(made);
    const std::string command = obscura::test::shellCommand(
        "{} --headless --scene toasters --time 2.5 --frames 1 --size 320x180 --method {} --view {} --screenshot {}", OBSCURA_GAME, method,
        view, target);
    const obscura::test::Ended ended = obscura::test::runShell(command);
    ASSERT_EQ(ended.code, 0) << command << "\n" << ended.error;
    const Pixels now(target), then(golden);
    ASSERT_TRUE(now.rgb) << target;
    ASSERT_TRUE(then.rgb) << golden << " is missing: run tools/renew " << method << ", review it, commit it";
    ASSERT_EQ(now.width, then.width);
    ASSERT_EQ(now.height, then.height);
    const size_t count = size_t(now.width) * size_t(now.height);
    const Family& family = familyOf(ended.out);
    size_t outliers = 0;
    int worst = 0;
    for (size_t i = 0; i < count; ++i) {
        int difference = 0;
        for (size_t c = 0; c < 3; ++c)
            difference = std::max(difference, std::abs(int(now.rgb.get()[i * 3 + c]) - int(then.rgb.get()[i * 3 + c])));
        outliers += difference > family.tolerance;
        worst = std::max(worst, difference);
    }
    std::printf("  %-20s worst %3d/255, %4zu of %zu pixels over %d/255 (%s)\n", method.c_str(), worst, outliers, count, family.tolerance,
        *family.name ? family.name : "another driver");
    EXPECT_LE(double(outliers), family.outliers * double(count)) << made << " differs from " << golden << ", worst by " << worst << "/255";
    if (!testing::Test::HasFailure() && !renew) fs::remove(made);
}

std::vector<std::string> ids() {
    std::vector<std::string> result;
    for (const obscura::ao::MethodInfo* info : obscura::ao::methods()) result.emplace_back(info->id);
    return result;
}

TEST(Golden, finalImageMatches) { check("hbao", "final"); }

class EveryMethod : public testing::TestWithParam<std::string> {};
TEST_P(EveryMethod, visibilityMatches) { check(GetParam(), "visibility"); }
INSTANTIATE_TEST_SUITE_P(Golden, EveryMethod, testing::ValuesIn(ids()), [](const auto& info) { return info.param; });

}  // namespace
