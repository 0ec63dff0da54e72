// What glTF files hold besides one scene at the origin: several animations, map coordinates, attributes of unknown extensions, variants.
#include <cmath>

#include <gtest/gtest.h>

#include "tools.h"
#include "truth/captured_frame.h"

namespace obscura::test {
namespace {

class Content : public testing::Test {
protected:
    fs::path file(const std::string& name) const { return m_folder / name; }
    // Depth of the frame that obscura-evaluate draws.
    truth::CapturedFrame capture(const fs::path& scene, const std::string& more = "") {
        const Ended ended = runShell(shellCommand("{} --scene {} --size 96x54 --guard 0 --method none --rays 32 --frames 1 "
                                                  "--reference screen --capture-out {} ",
                                         OBSCURA_EVALUATE, scene, file("frame")) +
                                     more);
        EXPECT_EQ(ended.code, 0) << ended.error;
        m_said = ended.error;
        return truth::readCapture(file("frame"));
    }
    static size_t different(const truth::CapturedFrame& a, const truth::CapturedFrame& b) {
        size_t count = 0;
        for (size_t i = 0; i < a.depth.size(); ++i) count += std::fabs(a.depth[i] - b.depth[i]) > 1e-3f * b.depth[i];
        return count;
    }
    TemporaryFolder m_folder;
    std::string m_said;
};

// The block, four times in a row; each has an animation that lifts it.
GltfBuilder fourBlocks() {
    GltfBuilder b = roomScene();
    b.json["nodes"].erase(1);
    b.json["scenes"][0]["nodes"] = {0};
    for (int i = 0; i < 4; ++i) {
        const float x = -2.25f + 1.5f * float(i);
        b.json["nodes"].push_back({{"mesh", 1}, {"scale", {0.6, 0.6, 0.6}}, {"translation", {x, 0, 0}}});
        b.json["scenes"][0]["nodes"].push_back(1 + i);
        b.json["animations"].push_back({{"name", "block" + std::to_string(i) + "Action"},
            {"samplers", {{{"input", b.scalars({0, 1, 2})}, {"output", b.vec3({x, 0, 0, x, 1, 0, x, 0, 0})}}}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", 1 + i}, {"path", "translation"}}}}}}});
    }
    return b;
}

TEST_F(Content, animationsPlayTogetherUnlessOneIsChosen) {
    write(file("blocks.glb"), fourBlocks().binary());
    write(file("camera.json"), R"({"eye":[0,1.5,6],"target":[0,0.7,0]})");
    const auto at = [&](const char* animation) {
        return capture(file("blocks.glb"), shellCommand("--time 1 --camera {} --animation {}", file("camera.json"), animation));
    };
    const truth::CapturedFrame none = at("none"), all = at("all");
    size_t sum = 0;
    for (int i = 0; i < 4; ++i) {
        const size_t one = different(at(("block" + std::to_string(i) + "Action").c_str()), none);
        EXPECT_GT(one, 10u) << i;
        EXPECT_EQ(one, different(at(std::to_string(i).c_str()), none)) << i;
        sum += one;
    }
    EXPECT_EQ(different(all, none), sum);
    const Ended ended = runShell(shellCommand("{} --headless --scene {} --animation block9Action", OBSCURA_GAME, file("blocks.glb")));
    EXPECT_EQ(ended.code, 2);
    EXPECT_EQ(ended.errorLines(), 1u) << ended.error;
    EXPECT_NE(ended.error.find("did you mean block0Action?"), std::string::npos) << ended.error;
}

TEST_F(Content, listSceneTellsWhatBecomesOfEverything) {
    GltfBuilder b = fourBlocks();
    b.json["animations"].push_back(b.json["animations"][2]);
    b.json["animations"][4]["name"] = "again";
    b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5235988}, {"znear", 0.25}, {"zfar", 80}}}},
        {{"type", "orthographic"}, {"name", "plan"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0}, {"zfar", 10}}}}};
    for (const int camera : {0, 1}) {
        b.json["scenes"][0]["nodes"].push_back(b.json["nodes"].size());
        b.json["nodes"].push_back({{"camera", camera}});
    }
    b.json["extensionsUsed"] = {"KHR_materials_variants", "KHR_materials_unlit"};
    b.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "red"}}};
    write(file("scene.glb"), b.binary());
    const Ended ended = runShell(shellCommand("{} --list-scene --scene {}", OBSCURA_GAME, file("scene.glb")));
    EXPECT_EQ(ended.code, 0) << ended.error;
    for (const char* line :
        {"--camera scene:0  camera 0, perspective, 30.0 degrees high, 0.25 to 80", "--camera scene:1  plan, orthographic, 6 high, 0 to 10",
            "--animation 0  block0Action, 2 s, plays\n", "--animation 4  again, 2 s, moves what an earlier one moves",
            "variant    red: ignored", "extension  KHR_materials_variants: ignored", "extension  KHR_materials_unlit: read"})
        EXPECT_NE(ended.out.find(line), std::string::npos) << line << "\n" << ended.out;
}

TEST_F(Content, mapCoordinatesShowTheSame) {
    GltfBuilder b = roomScene();
    b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.9}, {"znear", 0.1}}}}};
    b.json["nodes"].push_back({{"camera", 0}, {"translation", {0, 3, 8}}, {"rotation", {-0.1564344650, 0, 0, 0.9876883406}}});
    b.json["nodes"].push_back({{"children", {0, 1, 2}}});
    b.json["scenes"][0]["nodes"] = {3};
    write(file("origin.glb"), b.binary());
    const truth::CapturedFrame lens = capture(file("origin.glb"), "--camera scene:0");
    EXPECT_EQ(m_said, "");
    write(file("look.json"), R"({"loop":true,"duration":2,"keys":[{"time":0,"eye":[0,1,9],"target":[0,0,0]}],"scene":"a"})");
    for (const auto& [east, north] : {std::pair(100000.25, 100000.5), std::pair(500000.3, -5200000.7)}) {
        b.json["nodes"][3]["translation"] = {east, 0, north};
        write(file("far.glb"), b.binary());
        EXPECT_LT(different(capture(file("far.glb"), "--camera scene:0"), lens), lens.depth.size() / 200) << east;
        EXPECT_NE(m_said.find("from the file's origin; it is moved there"), std::string::npos) << m_said;
        const Ended ended =
            runShell(shellCommand("{} --headless --scene {} --size 96x54 --screenshot {}", OBSCURA_GAME, file("far.glb"), file("far.png")));
        EXPECT_EQ(ended.code, 0);
        EXPECT_EQ(ended.error.find("shows only sky"), std::string::npos) << ended.error;
    }
}

TEST_F(Content, attributesOfIgnoredExtensionsLeaveTheRest) {
    GltfBuilder b = roomScene();
    write(file("plain.glb"), b.binary());
    const Json splats{{"POSITION", b.vec3({0, 2, 0, 1, 2, 0})}, {"KHR_gaussian_splatting:OPACITY", b.scalars({1, 1})}};
    b.json["meshes"].push_back({{"primitives", {{{"mode", 0}, {"attributes", splats}}}}});
    b.json["scenes"][0]["nodes"].push_back(2);
    b.json["nodes"].push_back({{"mesh", 2}});
    b.json["extensionsUsed"] = {"KHR_gaussian_splatting"};
    write(file("splats.glb"), b.binary());
    const truth::CapturedFrame plain = capture(file("plain.glb"));
    EXPECT_EQ(different(capture(file("splats.glb")), plain), 0u);
    EXPECT_NE(m_said.find("the extension KHR_gaussian_splatting is ignored"), std::string::npos) << m_said;
}

}  // namespace
}  // namespace obscura::test
