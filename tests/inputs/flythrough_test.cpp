// obscura-flythrough on any scene: an orbit, a path, the file's animated camera, a fixed camera.
#include <map>
#include <set>

#include <fmt/ranges.h>
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

// Scenes of one name keep results apart: by extension, then by folder.
TEST_F(AnyScene, scenesOfOneNameAreToldApart) {
    std::vector<std::string> files;
    for (const char* name : {"before/room.glb", "after/room.glb", "room.gltf"}) {
        fs::create_directories((m_folder / name).parent_path());
        GltfBuilder b = roomScene(files.empty() ? 1.0f : 1.0f + 0.2f * float(files.size()));
        write(m_folder / name, b.binary());
        files.push_back((m_folder / name).string());
    }
    const std::string scenes = fmt::format("{}", fmt::join(files, ","));
    std::set<std::string> names;  // room.glb of fly() among them
    ASSERT_EQ(fly("--scene " + shellCommand("{}", scenes)).code, 0);
    for (const Json& part : parts()) names.insert(part["flythrough"].get<std::string>());
    EXPECT_EQ(names.size(), 4u);
    for (const char* name : {"before-room.glb.orbit", "after-room.glb.orbit", "room.gltf.orbit"}) EXPECT_TRUE(names.count(name)) << name;

    const std::string small = " --size 48x27 --rays 32 --method hbao --falloff quadratic:2 --frames 1 --out ";
    Ended ended = runShell(shellCommand("{} --scene {}", OBSCURA_EVALUATE, scenes) + small + shellCommand("{}", m_folder / "evaluate"));
    ASSERT_EQ(ended.code, 0) << ended.error;
    std::set<std::string> rows;
    for (const Json& row : Json::parse(textOf(m_folder / "evaluate/metrics.json"))) rows.insert(row["scene"].get<std::string>());
    EXPECT_EQ(rows, (std::set<std::string>{"after-room.glb", "before-room.glb", "room.gltf"}));

    ended = runShell(shellCommand("{} --scene {} --rounds 1 --flicker 0 --no-gpu-cost", OBSCURA_BENCH, scenes) + small +
                     shellCommand("{}", m_folder / "bench"));
    ASSERT_EQ(ended.code, 0) << ended.error;
    std::map<std::string, double> errors;
    const Json bench = Json::parse(textOf(m_folder / "bench/bench.json"));
    for (const Json& row : bench["rows"]) errors[row["scene"]] = row["errors"][0]["eA"];
    EXPECT_EQ(errors.size(), 3u);
    EXPECT_NE(errors["before-room.glb"], errors["after-room.glb"]);

    ended =
        runShell(shellCommand("{} --scene {}", OBSCURA_EVALUATE, files[0] + "," + files[0]) + small + shellCommand("{}", m_folder / "o"));
    EXPECT_EQ(ended.code, 2);
    EXPECT_NE(ended.error.find("is named twice"), std::string::npos) << ended.error;
}

// The walk of a block changes what obscura-bench measures at a time.
TEST_F(AnyScene, benchPlaysTheChosenAnimation) {
    const auto eA = [&](const std::string& more) {
        const Ended ended =
            runShell(shellCommand("{} --scene {} --camera scene:0 --size 48x27 --rays 32 --method hbao --rounds 1 --frames 1 "
                                  "--flicker 0 --no-gpu-cost --again --out {} ",
                         OBSCURA_BENCH, m_folder / "room.glb", m_folder / "bench") +
                     more);
        EXPECT_EQ(ended.code, 0) << ended.error;
        return Json::parse(textOf(m_folder / "bench/bench.json"))["rows"][0]["errors"][0]["eA"].get<double>();
    };
    const double rest = eA("--animation none --time 0.9");
    EXPECT_EQ(eA("--animation none"), rest);
    EXPECT_NE(eA("--time 0.9"), rest);
    EXPECT_NE(eA("--animation 0 --time 0.9"), rest);
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
