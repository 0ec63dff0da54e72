// The command line: invalid input prints one line with cause, place and remedy, and exits with 2; lists and help are complete.
#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.h"
#include "small_scene.h"

namespace obscura::test {
namespace {

void expectOneLine(const Ran& ran, const std::vector<std::string>& says) {
    EXPECT_EQ(ran.code, 2) << ran.err;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    EXPECT_TRUE(ran.err.starts_with("obscura: ")) << ran.err;
    EXPECT_EQ(ran.out, "");
    for (const std::string& word : says) EXPECT_NE(ran.err.find(word), std::string::npos) << "no '" << word << "' in: " << ran.err;
}

struct Bad {
    std::vector<std::string> arguments;
    std::vector<std::string> says;
};

TEST(CommandLine, InvalidOptionsPrintOneLine) {
    const Bad cases[] = {
        {{"--heedless"}, {"--heedless", "did you mean --headless?"}},
        {{"sponza"}, {"sponza", "--help"}},
        {{"--method", "hbaoo"}, {"--method hbaoo", "did you mean hbao?", "none"}},
        {{"--method"}, {"--method"}},
        {{"--preset", "lovely"}, {"--preset lovely", "default"}},
        {{"--resolve", "spacial"}, {"--resolve spacial", "did you mean spatial?"}},
        {{"--set", "hbao.directons=4"}, {"directons", "did you mean directions?"}},
        {{"--set", "hbao.directions=many"}, {"many", "1 to 32"}},
        {{"--set", "hbao.directions=1000"}, {"1000", "1 to 32"}},
        {{"--set", "hbao.directions=2.5"}, {"2.5", "whole number"}},
        {{"--set", "hbao.directions"}, {"METHOD.PARAMETER=VALUE"}},
        {{"--set", "hbau.directions=4"}, {"hbau", "did you mean hbao?"}},
        {{"--falloff", "quadratik:2"}, {"quadratik", "did you mean quadratic?"}},
        {{"--falloff", "quadratic:-1"}, {"quadratic:-1", "metres"}},
        {{"--falloff", "ramp:1"}, {"ramp:START:END"}},
        {{"--size", "1280"}, {"--size 1280", "WIDTHxHEIGHT"}},
        {{"--size", "1280x"}, {"--size 1280x"}},
        {{"--size", "1x99999"}, {"--size 1x99999", "8192"}},
        {{"--frames", "0"}, {"--frames"}},
        {{"--frames", "ten"}, {"--frames", "ten"}},
        {{"--guard", "0.7"}, {"--guard"}},
        {{"--view", "normal"}, {"--view normal", "did you mean normals?"}},
        {{"--eye", "1,2", "--target", "0,0,0"}, {"--eye 1,2", "three numbers"}},
        {{"--eye", "1,2,3"}, {"--eye", "--target"}},
        {{"--eye", "1,2,3", "--target", "1,2,3"}, {"--target"}},
        {{"--camera", "scene:x"}, {"scene:N"}},
        {{"--json"}, {"--json", "--list-methods"}},
        {{"--compare", "hbaoo"}, {"--compare hbaoo: no such method", "did you mean hbao?"}},
        {{"--compare", "hbao:lovely"}, {"--compare hbao:lovely: hbao has no such preset", "default"}},
        {{"--compare", "hbao:8x4,steps=0.5"}, {"--compare hbao:8x4,steps=0.5", "whole number"}},
        {{"--compare", "hbao,"}, {"--compare hbao,", "METHOD.PARAMETER=VALUE"}},
        {{"--split", "1.5"}, {"--split", "1.5"}},
        {{"--view", "difference"}, {"--view difference", "--compare"}},
        {{"--validation", "full"}, {"--validation", "full"}},
        {{"--time", "soon"}, {"--time", "soon"}},
    };
    for (const Bad& bad : cases) {
        SCOPED_TRACE(testing::PrintToString(bad.arguments));
        expectOneLine(run(bad.arguments), bad.says);
    }
}

TEST(CommandLine, InvalidFilesPrintOneLine) {
    const TemporaryFolder folder;
    const std::string scene = writeSmallScene(folder.path()).string();
    const std::string text = (folder / "text.glb").string(), camera = (folder / "camera.json").string(),
                      path = (folder / "path.json").string();
    std::ofstream(text) << "not a model";
    std::ofstream(camera) << R"({"eye": [0, 1], "target": [0, 0, 0]})";
    std::ofstream(path) << R"({"keys": []})";
    const Bad cases[] = {
        {{"--headless", "--scene", "atrim"}, {"atrim", "did you mean atrium?", "sponza"}},
        {{"--headless", "--scene", "/no/such/model.glb"}, {"/no/such/model.glb", "no such file"}},
        {{"--headless", "--scene", text}, {text}},
        {{"--headless", "--scene", scene, "--camera", camera}, {camera, "/eye"}},
        {{"--headless", "--scene", scene, "--camera", "/no/such.json"}, {"/no/such.json"}},
        {{"--headless", "--scene", scene, "--camera", "path:" + path}, {path, "/keys"}},
        {{"--headless", "--scene", scene, "--camera", "scene:0"}, {"scene:0", "no cameras"}},
        {{"--headless", "--scene", scene, "--screenshot", "/no/such/folder/a.png"}, {"/no/such/folder/a.png", "cannot be written"}},
        {{"--headless", "--scene", scene, "--screenshot", folder.path().string()}, {folder.path().string(), "folder"}},
        {{"--headless", "--scene", scene, "--out", text}, {text, "cannot be written"}},
        {{"--headless", "--scene", scene, "--device", "Voodoo 2"}, {"Voodoo 2", "there are"}},
        {{"--headless", "--scene", scene, "--size", "64x36", "--view", "pass:no such"}, {"pass:no such", "tone map"}},
    };
    for (const Bad& bad : cases) {
        SCOPED_TRACE(testing::PrintToString(bad.arguments));
        expectOneLine(run(bad.arguments), bad.says);
    }
}

TEST(CommandLine, RegistryAsJson) {
    const Ran ran = run({"--list-methods", "--json"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const auto list = nlohmann::json::parse(ran.out);
    ASSERT_GE(list.size(), 2u);
    EXPECT_EQ(list[0]["id"], "none");
    for (const auto& method : list) {
        for (const char* key : {"id", "title", "paper", "sentence"}) EXPECT_TRUE(method.at(key).is_string());
        EXPECT_EQ(method.at("presets").at(0).at("id"), "default");
        for (const auto& parameter : method.at("parameters")) {
            EXPECT_LE(parameter.at("minimum").get<double>(), parameter.at("initial").get<double>());
            EXPECT_GE(parameter.at("maximum").get<double>(), parameter.at("initial").get<double>());
            EXPECT_FALSE(parameter.at("sentence").get<std::string>().empty());
        }
        // Parameters named in the JSON can be set.
        EXPECT_EQ(run({"--list-scenes", "--method", method.at("id"), "--preset", method.at("presets").back().at("id")}).code, 0);
    }
}

TEST(CommandLine, HelpIsComplete) {
    const Ran ran = run({"--help"});
    EXPECT_EQ(ran.code, 0);
    for (const char* word :
        {"--headless", "--frames", "--size", "--scene", "--method", "--set", "--falloff", "--time", "--view", "--screenshot", "--out",
            "--list-methods", "--json", "--device", "--guard", "--preset", "--validation", "--flythrough", "--camera", "--eye",
            "--switch-test", "--compare", "--split", "--difference-range", "--path", "--bare", "--measure", "Keys:", "F11", "Tab", "1..9"})
        EXPECT_NE(ran.out.find(word), std::string::npos) << word;
}

TEST(CommandLine, ScenesAreListedWithHowToGetThem) {
    const Ran ran = run({"--list-scenes"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    for (const char* name : {"toasters", "atrium", "sponza", "dragon"}) EXPECT_NE(ran.out.find(name), std::string::npos) << name;
}

}  // namespace
}  // namespace obscura::test
