// Comparing two settings on one frame: each side equals the image of that setting alone; switched off, it adds no pass.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.h"
#include "small_scene.h"

namespace obscura::test {
namespace {

class Compare : public SmallSceneTest {
protected:
    // The last of three frames, so that history has an influence.
    Decoded shoot(const std::string& name, std::vector<std::string> more) {
        std::vector<std::string> arguments{
            "--headless", "--scene", m_scene, "--size", "97x54", "--frames", "3", "--falloff", "quadratic:1", "--screenshot", file(name)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Ran ran = run(arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(ran.err, "");
        return decodePng(file(name));
    }
};

const std::vector<std::string> kA{"--method", "hbao", "--set", "temporal=0.9"}, kB{"--method", "horizon_split", "--set", "temporal=0.8"};
const std::vector<std::string> kBoth{"--method", "hbao", "--set", "temporal=0.9", "--compare", "horizon_split,temporal=0.8"};

std::vector<std::string> with(std::vector<std::string> list, const std::vector<std::string>& more) {
    list.insert(list.end(), more.begin(), more.end());
    return list;
}

TEST_F(Compare, EitherSideEqualsTheMethodAlone) {
    for (const char* view : {"final", "visibility"}) {
        const Decoded a = shoot("a.png", with(kA, {"--view", view})), b = shoot("b.png", with(kB, {"--view", view}));
        ASSERT_NE(a.rgb, b.rgb);
        const int divider = 29;  // 0.3 x 97, rounded
        const Decoded both = shoot("both.png", with(kBoth, {"--view", view, "--split", "0.3", "--validation", "sync"}));
        ASSERT_EQ(both.rgb.size(), a.rgb.size());
        size_t wrong = 0, differ = 0;
        for (int y = 0; y < both.height; ++y)
            for (int x = 0; x < both.width; ++x)
                for (int c = 0; c < 3; ++c) {
                    const size_t i = size_t(y * both.width + x) * 3 + size_t(c);
                    wrong += both.rgb[i] != (x < divider ? a : b).rgb[i];
                    differ += a.rgb[i] != b.rgb[i];
                }
        EXPECT_EQ(wrong, 0u) << view;
        EXPECT_GT(differ, 100u) << view;
    }
}

TEST_F(Compare, DifferenceViewsShowSizeAndSign) {
    const std::vector<std::string> both{
        "--method", "hbao", "--compare", "hbao,directions=2,denoise=0", "--difference-range", "0.5"};  // noise: of either sign
    const Decoded a = shoot("a.png", with(both, {"--view", "visibility", "--split", "1"})),
                  b = shoot("b.png", with(both, {"--view", "visibility", "--split", "0"}));
    const Decoded size = shoot("size.png", with(both, {"--view", "difference"})),
                  sign = shoot("sign.png", with(both, {"--view", "signed-difference"}));
    ASSERT_EQ(size.rgb.size(), a.rgb.size());
    ASSERT_EQ(sign.rgb.size(), a.rgb.size());
    size_t lighter = 0, darker = 0;
    for (size_t i = 0; i < a.rgb.size(); i += 3) {
        const int d = int(a.rgb[i]) - int(b.rgb[i]);
        EXPECT_NEAR(double(size.rgb[i]), std::min(255.0, 2.0 * std::abs(d)), 3.0);  // difference of two rounded images, doubled
        if (std::abs(d) < 8) continue;
        // Orange where A is lighter, blue where it is darker.
        EXPECT_EQ(sign.rgb[i] > sign.rgb[i + 2], d > 0) << d;
        (d > 0 ? lighter : darker) += 1;
    }
    EXPECT_GT(lighter, 0u);
    EXPECT_GT(darker, 0u);
    const Decoded none = shoot("none.png", {"--method", "hbao", "--compare", "hbao", "--view", "difference"});
    EXPECT_EQ(*std::max_element(none.rgb.begin(), none.rgb.end()), 0) << "a method compared with itself differs nowhere";
}

TEST_F(Compare, PassNamesHaveThePrefixOfTheirSide) {
    const auto passes = [&](const std::vector<std::string>& options) {
        shoot("x.png", with(options, {"--frames", "6", "--out", file("out")}));
        std::string names;
        const auto timings = nlohmann::json::parse(bytesOf(m_folder / "out" / "timings.json"));
        for (const auto& pass : timings.at("passes")) names += pass.at("name").get<std::string>() + " ";
        return names;
    };
    const std::string alone = passes(kA), both = passes({"--method", "hbao", "--compare", "hbao:8x4"});
    for (const char* word : {"A.", "B.", "split"}) EXPECT_EQ(alone.find(word), std::string::npos) << alone;
    for (const char* word : {"A.hbao.", "B.hbao.", "A.prepare.", "B.prepare.", " split "})
        EXPECT_NE(both.find(word), std::string::npos) << word << " is not in " << both;
    const auto timings = nlohmann::json::parse(bytesOf(m_folder / "out" / "timings.json"));
    EXPECT_EQ(timings.at("compare").at("method"), "hbao");
    EXPECT_NE(timings.at("compare").at("parameters"), timings.at("parameters"));
}

}  // namespace
}  // namespace obscura::test
