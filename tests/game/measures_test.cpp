// Live measures of the game against obscura-flythrough, with the references cached by the latter.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.h"
#include "small_scene.h"

namespace obscura::test {
namespace {

namespace fs = std::filesystem;

// Rows by column name.
using Table = std::vector<std::map<std::string, std::string>>;
Table tableOf(const fs::path& file) {
    std::ifstream in(file);
    const auto split = [](const std::string& line) {
        std::vector<std::string> cells;
        std::istringstream text(line + ",");
        for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
        return cells;
    };
    std::string line;
    std::getline(in, line);
    const std::vector<std::string> names = split(line);
    Table table;
    while (std::getline(in, line)) {
        const std::vector<std::string> cells = split(line);
        auto& row = table.emplace_back();
        for (size_t i = 0; i < names.size() && i < cells.size(); ++i) row[names[i]] = cells[i];
    }
    return table;
}

class LiveMeasures : public SmallSceneTest {
protected:
    void SetUp() override {
        m_path = (m_folder / "flown.path.json").string();
        std::ofstream(m_path) << nlohmann::json{{"scene", m_scene}, {"loop", false}, {"duration", 0.2},
            {"keys", {{{"time", 0.3}, {"eye", {3, 2, 3}}, {"target", {0, 0, 0}}},
                         {{"time", 0.5}, {"eye", {2.5, 2.2, 3}}, {"target", {0, 0, 0}}}}}};
        ::setenv("OBSCURA_CACHE", (m_folder / "cache").c_str(), 1);
    }
    void TearDown() override { ::unsetenv("OBSCURA_CACHE"); }
    Ran play(const std::string& out, std::vector<std::string> more) {
        std::vector<std::string> arguments{"--headless", "--scene", m_scene, "--falloff", "quadratic:1", "--view", "visibility",
            "--measure", "--out", (m_folder / out).string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        Ran ran = run(arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        return ran;
    }
    Table measures(const std::string& out) const { return tableOf(m_folder / out / "measures.csv"); }
    std::string m_path;
};

TEST_F(LiveMeasures, AgreeWithTheFlythroughTool) {
    const fs::path flown = m_folder / "flown";
    const Ran tool = run({"--flythrough", m_path, "--length", "5", "--size", "64x36", "--rays", "256", "--falloff", "quadratic:1",
                             "--method", "hbao", "--set", "denoise=0", "--filter", "spatial", "--no-pictures", "--out", flown.string()},
        OBSCURA_FLYTHROUGH);
    ASSERT_EQ(tool.code, 0) << tool.err;
    const Ran ran = play(
        "game", {"--path", m_path, "--frames", "5", "--size", "64x36", "--method", "hbao", "--set", "denoise=0", "--validation", "sync"});
    EXPECT_NE(ran.out.find("5 of 5 frames have a reference"), std::string::npos) << ran.out;
    EXPECT_NE(ran.out.find("validation: 0 messages"), std::string::npos) << ran.out;
    Table wanted = tableOf(flown / "frames.csv"), got = measures("game");
    ASSERT_EQ(wanted.size(), 5u);
    ASSERT_EQ(got.size(), 5u);
    const std::pair<const char*, const char*> columns[] = {{"eA", "eA"}, {"bias", "bias"}, {"share", "share"}, {"difference", "D_A"},
        {"excess_flicker", "excess"}, {"flicker_of_error", "F_e"}};
    for (size_t i = 0; i < 5; ++i)
        for (const auto& [theirs, ours] : columns) {
            if (i == 0 && got[i][ours].empty()) continue;  // no previous frame
            ASSERT_FALSE(got[i].at(ours).empty()) << ours << " of frame " << i;
            EXPECT_NEAR(std::stod(wanted[i].at(theirs)), std::stod(got[i].at(ours)), 1e-4) << ours << " of frame " << i;
        }
    EXPECT_GT(std::stod(got[4].at("eA")), 0.005);
    EXPECT_GT(std::stod(got[4].at("D_A")), 0.0005);

    // Another falloff, time, size or world has no reference. At three times the size every third pixel has the same view ray.
    const std::vector<std::string> none{"--path", m_path, "--frames", "1", "--method", "none"};
    const auto referenced = [&](std::vector<std::string> more) {
        more.insert(more.begin(), none.begin(), none.end());
        return play("other", more).out.find("1 of 1 frames have a reference") != std::string::npos;
    };
    EXPECT_TRUE(referenced({"--size", "64x36"}));
    EXPECT_FALSE(referenced({"--size", "64x36", "--falloff", "quadratic:1.5"}));
    EXPECT_FALSE(referenced({"--size", "64x36", "--time", "0.31"}));
    EXPECT_FALSE(referenced({"--size", "72x36"}));
}

TEST_F(LiveMeasures, LargerImagesUseASmallReferenceAtEveryNthPixel) {
    const Ran tool = run({"--flythrough", m_path, "--length", "2", "--size", "160x90", "--rays", "64", "--falloff", "quadratic:1",
                             "--method", "none", "--filter", "raw", "--no-pictures", "--out", (m_folder / "flown").string()},
        OBSCURA_FLYTHROUGH);
    ASSERT_EQ(tool.code, 0) << tool.err;
    const Ran small = play("small", {"--path", m_path, "--frames", "2", "--size", "160x90", "--method", "none"});
    const Ran large = play("large", {"--path", m_path, "--frames", "2", "--size", "480x270", "--method", "none"});
    EXPECT_NE(small.out.find("160 x 90 pixels, step 1 px; 2 of 2"), std::string::npos) << small.out;
    EXPECT_NE(large.out.find("160 x 90 pixels, step 3 px; 2 of 2"), std::string::npos) << large.out;
    // Without obscurance the error depends only on the reference, so both sizes must use the same pixels.
    Table a = measures("small"), b = measures("large");
    for (size_t i = 0; i < 2; ++i) EXPECT_NEAR(std::stod(a[i].at("eA")), std::stod(b[i].at("eA")), 2e-4) << i;
    EXPECT_NEAR(std::stod(a[1].at("share")), std::stod(b[1].at("share")), 0.02);
}

TEST_F(LiveMeasures, NoiseIsMeasuredOnStillFrames) {
    const std::vector<std::string> still{"--size", "64x36", "--frames", "40", "--step", "0", "--time", "0.4", "--method", "hbao"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), still.begin(), still.end());
        return more;
    };
    play("calm", with({"--compare", "hbao,temporal=0.5,denoise=0"}));
    const Table rows = measures("calm");
    ASSERT_EQ(rows.size(), 80u);
    for (size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i].at("noise").empty(), i < 66) << "32 frames settle after the first";
    EXPECT_EQ(std::stod(rows[78].at("noise")), 0.0) << "A does not rotate its samples";
    EXPECT_EQ(rows[79].at("side"), "B");
    EXPECT_GT(std::stod(rows[79].at("noise")), 1e-4);
    EXPECT_GE(std::stod(rows[79].at("noise_p99")), std::stod(rows[79].at("noise")));
    EXPECT_EQ(rows[79].at("eA"), "") << "there is no reference";

    play("moving", {"--size", "64x36", "--frames", "40", "--step", "0.001", "--method", "none"});
    for (const auto& row : measures("moving")) EXPECT_EQ(row.at("noise"), "");
}

}  // namespace
}  // namespace obscura::test
