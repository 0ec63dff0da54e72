// obscura-evaluate without a device: false colours, candidates, options, the gate.
#include <fstream>

#include <gtest/gtest.h>

#include "app/complaint.h"
#include "command.h"
#include "gate.h"
#include "measure/false_colour.h"

namespace obscura::evaluate {
namespace {

// The message of the thrown complaint, or an empty string.
template <class Do>
std::string complaintOf(Do act) {
    try {
        act();
    } catch (const app::Complaint& complaint) {
        EXPECT_EQ(complaint.code, app::kBadInput);
        return complaint.what();
    }
    return "";
}

std::string parse(std::vector<const char*> words) {
    words.insert(words.begin(), "obscura-evaluate");
    return complaintOf([&] { parseOptions(int(words.size()), words.data()); });
}

TEST(FalseColour, lightnessGrowsWithErrorOfEitherSign) {
    const auto lightness = [](measure::Rgb c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; };
    for (const float sign : {-1.0f, 1.0f}) {
        float before = -1.0f;
        for (float e = 0.0f; e <= measure::kErrorRange; e += measure::kErrorRange / 16) {
            const float now = lightness(measure::errorColour(sign * e));
            EXPECT_GT(now, before) << sign * e;
            before = now;
        }
    }
    const measure::Rgb dark = measure::errorColour(-0.12f), bright = measure::errorColour(0.12f);
    EXPECT_GT(dark.b, dark.r);
    EXPECT_GT(bright.r, bright.b);
    const measure::Rgb beyond = measure::errorColour(-9.0f), end = measure::errorColour(-measure::kErrorRange);
    EXPECT_TRUE(beyond.r == end.r && beyond.g == end.g && beyond.b == end.b);
}

TEST(Candidates, methodsTimesPresets) {
    const auto all = measure::candidates({"all"}, {"all"}, {});
    size_t presets = 0;
    for (const ao::MethodInfo* info : ao::methods()) presets += info->presets.size();
    EXPECT_EQ(all.size(), presets);
    const auto two = measure::candidates({"hbao"}, {"default", "8x4"}, {"steps=5"});
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[1].label(), "hbao 8x4 steps=5");
    EXPECT_EQ(two[1].fileName(), "hbao.8x4.steps_5");
    EXPECT_EQ(two[1].values.count("steps"), 5u);
    EXPECT_EQ(two[1].values.count("directions"), 8u);
}

TEST(Candidates, errorsListValidNames) {
    EXPECT_NE(complaintOf([] { measure::candidates({"hbo"}, {"default"}, {}); }).find("did you mean hbao"), std::string::npos);
    EXPECT_NE(complaintOf([] { measure::candidates({"hbao"}, {"fast"}, {}); }).find("8x4"), std::string::npos);
    EXPECT_NE(complaintOf([] { measure::candidates({"hbao"}, {"default"}, {"step=4"}); }).find("did you mean steps"), std::string::npos);
    EXPECT_NE(complaintOf([] { measure::candidates({"hbao"}, {"default"}, {"steps=400"}); }).find("from 1 to 32"), std::string::npos);
    EXPECT_NE(complaintOf([] { measure::candidates({"hbao"}, {"default"}, {"none.steps=4"}); }).find("not among"), std::string::npos);
    EXPECT_NE(complaintOf([] { measure::falloffs({"quadric:2"}); }).find("did you mean quadratic"), std::string::npos);
    EXPECT_NE(complaintOf([] { measure::falloffs({"quadratic:-2"}); }).find("above 0"), std::string::npos);
}

TEST(Options, contradictionsAreErrors) {
    EXPECT_NE(parse({}).find("--scene"), std::string::npos);
    EXPECT_NE(parse({"--capture", "f.exr"}).find("--camera FILE.json"), std::string::npos);
    EXPECT_NE(parse({"--scene", "toasters", "--size", "10"}).find("WIDTHxHEIGHT"), std::string::npos);
    EXPECT_NE(parse({"--scene", "toasters", "--camera", "scene"}).find("scene:N"), std::string::npos);
    EXPECT_NE(parse({"--scene", "toasters", "--reference", "word"}).find("did you mean world"), std::string::npos);
    EXPECT_NE(parse({"--scene", "toasters", "--channel", "a"}).find("--reference FILE.exr"), std::string::npos);
    EXPECT_NE(parse({"--capture", "f.exr", "--camera", "f.json", "--reference", "world"}).find("no triangles"), std::string::npos);
    EXPECT_NE(parse({"--capture", "f.exr", "--camera", "f.json", "--size", "64x36"}).find("leave out"), std::string::npos);
    EXPECT_NE(parse({"--gallery", "--every", "4"}).find("--every excludes --gallery"), std::string::npos);
    EXPECT_NE(parse({"--check-baseline", "b.json", "--every", "4"}).find("--every excludes --check-baseline"), std::string::npos);
    EXPECT_NE(parse({"--scene", "toasters", "--metod", "hbao"}).find("did you mean --method"), std::string::npos);
}

TEST(Options, galleryShowsEverythingByDefault) {
    const char* words[] = {"obscura-evaluate", "--gallery", "--scene", "toasters"};
    const auto options = parseOptions(4, words);
    ASSERT_TRUE(options);
    EXPECT_EQ(options->job, Job::gallery);
    EXPECT_EQ(options->page, "gallery.html");
    EXPECT_EQ(options->candidates.size(), measure::candidates({"all"}, {"default"}, {}).size());
    EXPECT_EQ(options->falloffs.size(), 2u);
    EXPECT_TRUE(options->reference.world && options->reference.screen);
}

TEST(Options, galleryIsWrittenToOutFolder) {
    const char* inside[] = {"obscura-evaluate", "--gallery", "--scene", "toasters", "--out", "some/folder"};
    EXPECT_EQ(parseOptions(6, inside)->page, "some/folder/gallery.html");
    const char* named[] = {"obscura-evaluate", "--gallery", "mine.html", "--scene", "toasters", "--out", "some/folder"};
    EXPECT_EQ(parseOptions(7, named)->page, "some/folder/mine.html");
    const char* elsewhere[] = {"obscura-evaluate", "--gallery", "./mine.html", "--scene", "toasters", "--out", "some/folder"};
    EXPECT_EQ(parseOptions(7, elsewhere)->page, "./mine.html");
}

Baseline small() {
    Baseline baseline;
    baseline.scenes = {"toasters"};
    baseline.cameras = {"own"};
    baseline.falloffs = {"quadratic:2"};
    baseline.references = {"world"};
    baseline.cells[{"hbao", "default", "toasters", "own", "quadratic:2", "world"}] = 0.1f;
    baseline.cells[{"none", "default", "toasters", "own", "quadratic:2", "world"}] = 0.001f;
    return baseline;
}

TEST(Gate, baselineRoundTrips) {
    const TemporaryFolder scratch;
    const Baseline written = small();
    std::ofstream(scratch / "b.json") << baselineText(written);
    const Baseline read = readBaseline(scratch / "b.json");
    EXPECT_EQ(read.cells, written.cells);
    EXPECT_EQ(read.size, written.size);
    EXPECT_EQ(read.cameras, written.cameras);
    EXPECT_EQ(baselineText(read), baselineText(written));
}

TEST(Gate, failsOnlyWhenWorseByBothTolerances) {
    const Baseline baseline = small();
    std::map<Cell, float> measured = baseline.cells;
    const Cell large = measured.begin()->first, tiny = measured.rbegin()->first;
    EXPECT_TRUE(judge(baseline, measured).passes());
    measured[large] = 0.1029f;  // +2.9 %
    measured[tiny] = 0.0014f;   // +40 %, but only 0.0004
    EXPECT_TRUE(judge(baseline, measured).passes());
    measured[large] = 0.1031f;
    EXPECT_EQ(judge(baseline, measured).worse.size(), 1u);
    measured[tiny] = 0.0016f;
    EXPECT_EQ(judge(baseline, measured).worse.size(), 2u);
    measured[large] = 0.05f;
    EXPECT_EQ(judge(baseline, measured).better.size(), 1u);
}

TEST(Gate, cellWithoutBaselineFails) {
    const Baseline baseline = small();
    std::map<Cell, float> measured = baseline.cells;
    Cell added = measured.begin()->first;
    added.method = "new";
    measured[added] = 0.1f;
    EXPECT_EQ(judge(baseline, measured).missing.size(), 1u);
    EXPECT_FALSE(judge(baseline, measured).passes());
    measured.clear();
    EXPECT_EQ(judge(baseline, measured).gone.size(), 2u);
}

}  // namespace
}  // namespace obscura::evaluate
