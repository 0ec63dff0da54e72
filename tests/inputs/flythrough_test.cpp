// obscura-flythrough on any scene: an orbit, a path, the file's animated camera, a fixed camera.
#include <gtest/gtest.h>

#include "tools.h"

namespace obscura::test {
namespace {

class AnyScene : public testing::Test {
protected:
    void SetUp() override {
        GltfBuilder b = roomScene();
        b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.9}, {"znear", 0.1}}}}};
        b.json["nodes"].push_back({{"camera", 0}, {"translation", {0, 1, 4}}});
        b.json["scenes"][0]["nodes"].push_back(2);
        // The camera moves by 1 m in 1 s.
        b.json["animations"] = {{{"samplers", {{{"input", b.scalars({0, 1})}, {"output", b.vec3({0, 1, 4, 1, 1, 4})}}}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}}}}};
        write(m_folder / "room.glb", b.binary());
        write(m_folder / "look.json", R"({"eye":[0,2,4],"target":[0,0.5,0]})");
        write(m_folder / "walk.path.json",
            R"({"loop":false,"keys":[{"time":0,"eye":[0,2,4],"target":[0,0.5,0]},{"time":1,"eye":[1,2,4],"target":[0,0.5,0]}]})");
    }
    Ended fly(const std::string& more) {
        return runShell(shellCommand("{} --scene {} --size 48x27 --length 3 --rays 32 --method hbao --modes raw --no-video --out {} ",
                            OBSCURA_FLYTHROUGH, m_folder / "room.glb", m_folder / "out") +
                        more);
    }
    Json parts() const { return Json::parse(textOf(m_folder / "out/report.json"))["parts"]; }
    TemporaryFolder m_folder;
};

TEST_F(AnyScene, isFlownByEveryKindOfCamera) {
    const Ended ended = fly(shellCommand("--camera {}",
        "orbit,scene:0,own," + (m_folder / "look.json").string() + ",path:" + (m_folder / "walk.path.json").string() + "@0.5"));
    ASSERT_EQ(ended.code, 0) << ended.error;
    const Json all = parts();
    ASSERT_EQ(all.size(), 5u);
    for (const Json& part : all) {
        EXPECT_GT(part["eA"].get<double>(), 0.0) << part["name"];
        const bool moves = part["flythrough"] != "room.look.json";
        EXPECT_EQ(part["difference"].get<double>() > 0.0, moves) << part["name"] << part["difference"];
    }
    EXPECT_TRUE(fs::exists(m_folder / "out/report.html"));
}

TEST_F(AnyScene, isMeasuredAgainIfTheAnimationChanges) {
    ASSERT_EQ(fly("--camera scene:0").code, 0);
    const Json before = parts();
    ASSERT_EQ(fly("--camera scene:0 --animation none").code, 0);
    EXPECT_NE(parts()[0]["eA"], before[0]["eA"]);
    EXPECT_EQ(parts()[0]["difference"].get<double>(), 0.0);
}

TEST_F(AnyScene, mistakesAreOneLine) {
    const auto refused = [&](const std::string& more, const char* why) {
        const Ended ended = fly(more);
        EXPECT_EQ(ended.code, 2) << ended.error;
        EXPECT_EQ(ended.errorLines(), 1u) << ended.error;
        EXPECT_NE(ended.error.find(why), std::string::npos) << ended.error;
    };
    refused("--camera scene:3", "has 1 cameras");
    refused("--camera missing.json", "no such file");
    refused("--camera path:missing.json@0", "no such file");
    refused("--camera circle", "write own, scene:N");
    refused("--animation run", "has no such animation");
}

}  // namespace
}  // namespace obscura::test
