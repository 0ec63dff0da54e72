// Headless runs: complete images of the right size, deterministic bytes, summary, animation and cameras.
#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.h"
#include "small_scene.h"

namespace obscura::test {
namespace {

class Headless : public SmallSceneTest {
protected:
    Ran shoot(const std::string& name, std::vector<std::string> more) {
        std::vector<std::string> arguments{"--headless", "--scene", m_scene, "--size", "96x54", "--screenshot", file(name)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
};

TEST_F(Headless, ScreenshotIsCompleteAndHasItsSize) {
    const Ran ran = shoot("a.png", {"--validation", "sync"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    EXPECT_NE(ran.out.find("validation: 0 messages"), std::string::npos) << ran.out;
    const Decoded picture = decodePng(file("a.png"));
    EXPECT_EQ(picture.width, 96);
    EXPECT_EQ(picture.height, 54);
    ASSERT_FALSE(picture.rgb.empty());
    EXPECT_GT(*std::max_element(picture.rgb.begin(), picture.rgb.end()), *std::min_element(picture.rgb.begin(), picture.rgb.end()) + 40);
    EXPECT_EQ(m_folder.files().size(), 3u);  // the scene's two and the picture
}

TEST_F(Headless, SameCommandSameBytes) {
    ASSERT_EQ(shoot("a.png", {"--frames", "4", "--time", "0.3"}).code, 0);
    ASSERT_EQ(shoot("b.png", {"--frames", "4", "--time", "0.3"}).code, 0);
    EXPECT_EQ(bytesOf(file("a.png")), bytesOf(file("b.png")));
}

TEST_F(Headless, TimeMethodViewAndCameraChangeThePicture) {
    ASSERT_EQ(shoot("still.png", {}).code, 0);
    const std::vector<std::string> changes[] = {{"--time", "0.5"}, {"--method", "none"}, {"--view", "visibility"}, {"--view", "normals"},
        {"--view", "bent-normals"}, {"--bent-normals"}, {"--view", "pass:gbuffer"}, {"--eye", "0,3,6", "--target", "0,0,0"},
        {"--fov", "40"}, {"--exposure", "4"}};
    const std::string still = bytesOf(file("still.png"));
    for (const auto& change : changes) {
        const Ran ran = shoot("changed.png", change);
        ASSERT_EQ(ran.code, 0) << ran.err;
        EXPECT_NE(still, bytesOf(file("changed.png"))) << testing::PrintToString(change);
    }
}

TEST_F(Headless, ObscuranceDarkensTheFootOfTheBox) {
    ASSERT_EQ(shoot("v.png", {"--view", "visibility", "--falloff", "quadratic:1", "--eye", "-1,2,4", "--target", "-1,0,0.5"}).code, 0);
    const Decoded v = decodePng(file("v.png"));
    ASSERT_FALSE(v.rgb.empty());
    // The foot of the box is right of and above the middle of the image; the floor far in front is open.
    const auto at = [&](int x, int y) { return int(v.rgb[size_t(y * v.width + x) * 3]); };
    int darkest = 255;
    for (int y = 20; y < 40; ++y)
        for (int x = 30; x < 66; ++x) darkest = std::min(darkest, at(x, y));
    EXPECT_LT(darkest, 190);
    EXPECT_GT(at(8, 50), darkest + 30);
}

// A method without bent normals lights as before.
TEST_F(Headless, BentNormalsNeedAMethodThatHasThem) {
    ASSERT_EQ(shoot("a.png", {"--method", "ssao"}).code, 0);
    ASSERT_EQ(shoot("b.png", {"--method", "ssao", "--bent-normals"}).code, 0);
    EXPECT_EQ(bytesOf(file("a.png")), bytesOf(file("b.png")));
    ASSERT_EQ(shoot("c.png", {"--method", "hbao"}).code, 0);
    ASSERT_EQ(shoot("d.png", {"--method", "hbao", "--bent-normals", "--compare", "ssao", "--split", "1"}).code, 0);
    EXPECT_EQ(bytesOf(file("c.png")), bytesOf(file("d.png"))) << "both sides need them";
}

TEST_F(Headless, OutHoldsFramesSummaryAndTimings) {
    const Ran ran = shoot("last.png", {"--frames", "6", "--flythrough", "--out", file("out")});
    ASSERT_EQ(ran.code, 0) << ran.err;
    for (int i = 0; i < 6; ++i) EXPECT_EQ(decodePng(m_folder / "out" / ("frame_000" + std::to_string(i) + ".png")).width, 96) << i;
    EXPECT_EQ(bytesOf(file("last.png")), bytesOf(m_folder / "out" / "frame_0005.png"));
    const auto timings = nlohmann::json::parse(bytesOf(m_folder / "out" / "timings.json"));
    EXPECT_EQ(timings.at("width"), 96);
    EXPECT_EQ(timings.at("frames"), 6);
    EXPECT_EQ(timings.at("measured"), 3) << "the first three are left out";
    bool found = false;
    for (const auto& pass : timings.at("passes")) found |= pass.at("name") == "gbuffer" && pass.at("median").is_number();
    EXPECT_TRUE(found);
    const std::string page = bytesOf(m_folder / "out" / "summary.html");
    EXPECT_NE(page.find("data:image/png;base64,"), std::string::npos);
    EXPECT_EQ(page.find("src=\"http"), std::string::npos) << "the page must not load external resources";
    EXPECT_NE(page.find("gbuffer"), std::string::npos);
    EXPECT_NE(ran.out.find("gbuffer"), std::string::npos);
}

TEST_F(Headless, CamerasFromFilesAndPaths) {
    std::ofstream(file("camera.json")) << R"({"eye": [0, 3, 6], "target": [0, 0, 0], "verticalFovDegrees": 60})";
    std::ofstream(file("path.json")) << R"({"duration": 2, "loop": false, "keys": [{"time": 0, "eye": [4, 2, 4], "target": [0, 0, 0]},
                                            {"time": 2, "eye": [0, 3, 6], "target": [0, 0, 0], "verticalFovDegrees": 60}]})";
    ASSERT_EQ(shoot("a.png", {"--camera", file("camera.json")}).code, 0);
    ASSERT_EQ(shoot("b.png", {"--camera", "path:" + file("path.json") + "@2"}).code, 0);
    ASSERT_EQ(shoot("c.png", {"--camera", "path:" + file("path.json") + "@0"}).code, 0);
    EXPECT_EQ(bytesOf(file("a.png")), bytesOf(file("b.png")));
    EXPECT_NE(bytesOf(file("a.png")), bytesOf(file("c.png")));
}

TEST_F(Headless, UnusualUnitsAreFitted) {
    writeSmallScene(m_folder.path(), 1000.0f);
    const Ran large = shoot("large.png", {});
    EXPECT_EQ(large.code, 0) << large.err;
    EXPECT_NE(large.err.find("times its size"), std::string::npos) << large.err;
    const Decoded picture = decodePng(file("large.png"));
    EXPECT_EQ(picture.width, 96);
}

TEST_F(Headless, SwitchTestReports) {
    const Ran ran = run({"--headless", "--scene", m_scene, "--size", "96x54", "--switch-test", "1"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find("worst frame at a switch"), std::string::npos) << ran.out;
}

TEST_F(Headless, MissingContentSaysHowToGetIt) {
    // The dragon cannot be generated: where it is missing, the error must say how to get it.
    const Ran list = run({"--list-scenes"});
    if (list.out.find("missing: put scenes/dragon.glb") == std::string::npos) GTEST_SKIP() << "dragon.glb exists";
    const Ran ran = run({"--headless", "--scene", "dragon"});
    EXPECT_EQ(ran.code, 2);
    EXPECT_NE(ran.err.find("OBSCURA_CONTENT"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace obscura::test
