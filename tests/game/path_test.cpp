// Camera paths: recording, replay at fixed steps, deterministic frames.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.h"
#include "recording.h"
#include "small_scene.h"

namespace obscura::test {
namespace {

TEST(Recorder, RecordsAtMostOneKeyAFrameAndRoundTrips) {
    const TemporaryFolder folder;
    game::Recorder recorder;
    recorder.start("toasters");
    scene::Camera camera;
    for (int i = 0; i <= 200; ++i) {  // a hundred frames a second, with a pause
        const float time = 3.0f + 0.01f * float(i < 100 ? i : i < 120 ? 100 : i - 20);
        camera.eye = {0.1f * float(i), 1.7f, std::sin(0.05f * float(i))};
        camera.target = camera.eye + glm::vec3(0.3f, 0.1f, -0.7f);
        ASSERT_TRUE(recorder.add(time, camera));
    }
    EXPECT_FALSE(recorder.add(2.0f, camera)) << "time cannot go back";
    EXPECT_NEAR(recorder.seconds(), 1.8f, 0.05f);
    const scene::CameraPath path = recorder.finish();
    EXPECT_FALSE(recorder.running());
    EXPECT_FALSE(path.loop);
    EXPECT_LE(path.keys.size(), 56u);
    EXPECT_GE(path.keys.size(), 40u);
    for (size_t i = 1; i < path.keys.size(); ++i) EXPECT_GE(path.keys[i].time - path.keys[i - 1].time, 0.999f / game::kReplayRate);

    path.save(folder / "a.path.json");
    const scene::CameraPath again = scene::loadCameraPath(folder / "a.path.json");
    EXPECT_EQ(again.scene, "toasters");
    EXPECT_EQ(game::replayFrames(again, again.keys.front().time), game::replayFrames(path, path.keys.front().time));
    for (uint32_t frame = 0; frame < game::replayFrames(path, 3.0f); ++frame) {
        const float time = game::replayTime(3.0f, frame);
        EXPECT_EQ(again.at(time).eye, path.at(time).eye) << frame;
        EXPECT_EQ(again.at(time).target, path.at(time).target) << frame;
        EXPECT_EQ(again.at(time).fovY, path.at(time).fovY) << frame;
    }
    // The replayed curve passes through the recorded positions.
    for (const scene::CameraPath::Key& key : path.keys) EXPECT_LT(glm::length(path.at(key.time).eye - key.eye), 1e-4f);
}

TEST(Recorder, ReplayShowsFirstAndLastKey) {
    scene::CameraPath path;
    path.keys = {{2.0f, {}, {0, 0, 1}}, {3.0f, {}, {0, 0, 1}}};
    path.loop = false;
    path.duration = 1.0f;
    EXPECT_EQ(game::replayFrames(path, 2.0f), 31u);
    EXPECT_EQ(game::replayFrames(path, 2.5f), 16u);
    EXPECT_EQ(game::replayFrames(path, 9.0f), 1u);
    path.loop = true;
    EXPECT_EQ(game::replayFrames(path, 2.0f), 30u);
}

class Replay : public SmallSceneTest {
protected:
    void SetUp() override {
        m_path = (m_folder / "flown.path.json").string();
        std::ofstream(m_path) << nlohmann::json{{"name", "flown"}, {"scene", m_scene}, {"loop", false}, {"duration", 0.2},
            {"keys",
                {{{"time", 0.3}, {"eye", {4, 2, 4}}, {"target", {0, 0, 0}}}, {{"time", 0.5}, {"eye", {3, 3, 5}}, {"target", {0, 0, 0}}}}}};
    }
    Ran fly(const std::string& out, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{
            "--headless", "--scene", m_scene, "--size", "96x54", "--path", m_path, "--out", (m_folder / out).string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    std::string frame(const std::string& out, int i) { return bytesOf(m_folder / out / ("frame_000" + std::to_string(i) + ".png")); }
    std::string m_path;
};

TEST_F(Replay, IsDeterministicAndComplete) {
    ASSERT_EQ(fly("a").code, 0);
    ASSERT_EQ(fly("b", {"--step", "0.5"}).code, 0) << "a replay ignores --step";
    for (int i = 0; i < 7; ++i) {
        EXPECT_FALSE(frame("a", i).empty()) << i;
        EXPECT_EQ(frame("a", i), frame("b", i)) << i;
        if (i) {
            EXPECT_NE(frame("a", i), frame("a", i - 1)) << i;
        }
    }
    EXPECT_TRUE(frame("a", 7).empty()) << "0.2 s have seven frames";
    // A replay from frame 3 on shows the same camera and world.
    ASSERT_EQ(fly("c", {"--time", "0.4", "--frames", "1", "--method", "none", "--aa", "none"}).code, 0);
    ASSERT_EQ(fly("d", {"--method", "none", "--aa", "none"}).code, 0);
    EXPECT_EQ(frame("c", 0), frame("d", 3));
}

TEST_F(Replay, InvalidInputPrintsOneLine) {
    const Ran both = fly("x", {"--eye", "1,2,3", "--target", "0,0,0"});
    EXPECT_EQ(both.code, 2);
    EXPECT_NE(both.err.find("--path"), std::string::npos) << both.err;
    const Ran none = run({"--headless", "--scene", m_scene, "--path", "/no/such.path.json"});
    EXPECT_EQ(none.code, 2);
    EXPECT_NE(none.err.find("/no/such.path.json"), std::string::npos) << none.err;
    EXPECT_EQ(std::count(none.err.begin(), none.err.end(), '\n'), 1) << none.err;
}

}  // namespace
}  // namespace obscura::test
