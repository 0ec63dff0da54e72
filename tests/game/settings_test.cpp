// Remembered settings, names of settings as options, and the choice of a method by its cost.
#include <fstream>

#include <gtest/gtest.h>

#include "../temporary_folder.h"
#include "app/complaint.h"
#include "choice.h"
#include "recommendation.h"

namespace obscura::game {
namespace {

// The values that the options choose on the command line.
ao::Values chosenBy(const std::vector<Argument>& options) {
    Choice choice;
    for (const auto& [option, value] : options) {
        if (option == "--method") choice.select(value);
        if (option == "--preset") choice.applyPreset(value);
        if (option == "--resolve") choice.applyResolve(value);
        if (option == "--set") choice.assign(value);
    }
    return choice.values();
}

TEST(MethodOptions, chooseTheSameValues) {
    for (const ao::MethodInfo* info : ao::methods())
        for (const ao::Preset& preset : info->presets) {
            Choice choice;
            choice.select(std::string(info->id));
            choice.applyPreset(preset.id);
            EXPECT_TRUE(chosenBy(methodOptions(choice.values())) == choice.values()) << info->id << " " << preset.id;
            if (!info->needs) continue;
            choice.applyResolve("temporal");
            EXPECT_TRUE(chosenBy(methodOptions(choice.values())) == choice.values()) << info->id << " " << preset.id << " temporal";
            Choice read;
            read.read(compareText(choice.values()));
            EXPECT_TRUE(read.values() == choice.values()) << compareText(choice.values());
            choice.assign("intensity=0.75");
            EXPECT_TRUE(chosenBy(methodOptions(choice.values())) == choice.values()) << info->id << " " << preset.id << " own";
        }
}

TEST(Label, namesPresetAndResolve) {
    Choice choice;
    choice.select("gtao");
    EXPECT_EQ(label(choice.values()), "gtao");
    choice.applyResolve("temporal");
    EXPECT_EQ(label(choice.values()), "gtao, temporal");
    choice.applyPreset("low");
    choice.applyResolve("temporal");
    EXPECT_EQ(label(choice.values()), "gtao low, temporal");
}

TEST(UsePreset, keepsTheResolve) {
    Choice choice;
    choice.select("gtao");
    choice.applyResolve("temporal");
    for (const ao::Preset& preset : choice.info().presets) {
        usePreset(choice.values(), preset);
        EXPECT_GT(choice.values()["temporal"], 0.0f) << preset.id;
    }
}

TEST(Recommendation, isTheMostAccurateWithinTheBudget) {
    EXPECT_EQ(recommend({0.5, 0.8, 1.2, 1.9, 2.4}, 2.0).candidate, 3u);
    EXPECT_EQ(recommend({3.0}, 2.0).candidate, 0u);
    EXPECT_EQ(recommend({}, 2.0).candidate, 0u);
    // Depth layers may cost more than the rest: a dearer candidate can take less time than the one before.
    EXPECT_EQ(recommend({0.5, 2.1, 1.9}, 2.0).candidate, 2u);
    EXPECT_EQ(recommend({0.5, 0.8, 2.4}, 2.0).reason(), "layered low takes 0.8 of 2 ms; layered medium would take 2.4");
    EXPECT_EQ(recommend({3.0}, 2.0).reason(), "gtao half takes 3 of 2 ms; nothing takes less");
}

TEST(Recommendation, candidatesAreTemporalAndEachMoreAccurateThanTheOneBefore) {
    const KnownFigures figures;
    double last = 1.0;
    for (const ao::Values& values : candidates()) {
        const auto [preset, resolve] = presetsOf(values);
        ASSERT_TRUE(preset && resolve);
        EXPECT_STREQ(resolve->id, "temporal");
        const auto known = figures.of(values.info().id, preset->id);
        ASSERT_TRUE(known) << label(values);
        EXPECT_LT(known->eA, last) << label(values);
        last = known->eA;
    }
}

TEST(Settings, areReadAsWritten) {
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder / "deep" / "settings";
    EXPECT_TRUE(readSettings(file).empty());
    const std::vector<Argument> settings{{"--size", "640x360"}, {"--bent-normals", ""}, {"--set", "steps=4"}};
    writeSettings(file, settings);
    EXPECT_EQ(readSettings(file), settings);
    std::ofstream(file) << "--size 1x1\nmethod = gtao\n";
    try {
        readSettings(file);
        FAIL() << "read a broken file";
    } catch (const app::Complaint& complaint) {
        EXPECT_NE(std::string(complaint.what()).find("line 2"), std::string::npos) << complaint.what();
    }
}

TEST(Settings, areQuotedForAShell) {
    EXPECT_EQ(asText({{"--scene", "my scene's.gltf"}, {"--bare", ""}, {"--eye", "-1,2.5,0"}}),
        "--scene 'my scene'\\''s.gltf' --bare --eye -1,2.5,0");
}

}  // namespace
}  // namespace obscura::game
