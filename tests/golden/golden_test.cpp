// Each method's visibility of the toasters, and the final picture, against pictures that somebody looked at. At most 0.1 %
// of the pixels may differ by more than 5/255: what another driver's rounding does, and less than a mistake does.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#define STB_IMAGE_IMPLEMENTATION
#include <stb_image.h>

#include "../shell.h"
#include "obscura/ao.h"

namespace {

namespace fs = std::filesystem;
const fs::path kFolder = fs::path(OBSCURA_SOURCE_DIR) / "tests" / "golden";
constexpr int kTolerance = 5;
constexpr double kOutliers = 0.001;

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
    const bool renew = std::getenv("OBSCURA_RENEW_GOLDEN") != nullptr;
    const fs::path target = renew ? golden : made;
    fs::remove(made);
    const std::string command = obscura::test::shellCommand(
        "{} --headless --scene toasters --time 2.5 --frames 1 --size 320x180 --method {} --view {} --screenshot {}", OBSCURA_GAME, method, view,
        target);
    const obscura::test::Ended ended = obscura::test::runShell(command);
    ASSERT_EQ(ended.code, 0) << command << "\n" << ended.error;
    const Pixels now(target), then(golden);
    ASSERT_TRUE(now.rgb) << target;
    ASSERT_TRUE(then.rgb) << golden << " is missing: run tests/golden/renew, look at it, commit it";
    ASSERT_EQ(now.width, then.width);
    ASSERT_EQ(now.height, then.height);
    const size_t count = size_t(now.width) * size_t(now.height);
    size_t outliers = 0;
    int worst = 0;
    for (size_t i = 0; i < count; ++i) {
        int difference = 0;
        for (size_t c = 0; c < 3; ++c) difference = std::max(difference, std::abs(int(now.rgb.get()[i * 3 + c]) - int(then.rgb.get()[i * 3 + c])));
        outliers += difference > kTolerance;
        worst = std::max(worst, difference);
    }
    EXPECT_LE(double(outliers), kOutliers * double(count)) << made << " differs from " << golden << ", worst by " << worst << "/255";
    if (!testing::Test::HasFailure() && !renew) fs::remove(made);
}

TEST(Golden, finalPicture) { check("hbao", "final"); }

TEST(Golden, visibilityOfEveryMethod) {
    for (const obscura::ao::MethodInfo* info : obscura::ao::methods()) {
        SCOPED_TRACE(info->id);
        check(info->id, "visibility");
    }
}

}  // namespace
