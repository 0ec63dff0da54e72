// Names of files and folders in any bytes through every program that writes results: the results are kept, and their texts are UTF-8.
#include <gtest/gtest.h>

#include "scene/json_text.h"
#include "tools.h"

namespace obscura::test {
namespace {

struct Name {
    const char* what;
    std::string bytes;
};
void PrintTo(const Name& name, std::ostream* out) { *out << name.what; }
const Name kNames[] = {{"latin1",
                           "stra\xdf"
                           "e"},
    {"truncated", "caf\xc3"}, {"quotes", "it's \"so\""}, {"markup", "<b>&amp;"}, {"lines", "two\nlines"},
    {"utf8", "\xe6\x97\xa5\xe6\x9c\xac"}};

class Names : public testing::TestWithParam<Name> {
protected:
    void SetUp() override {
        fs::create_directories(folder());
        write(scene(), roomScene().binary());
        write(camera(), R"({"eye":[0,2,4],"target":[0,0.5,0]})");
        write(path(), scene::dump(Json{{"scene", "toasters"}, {"loop", false},
                          {"keys", Json::array({{{"time", 0}, {"eye", {0, 2, 4}}, {"target", {0, 0.5, 0}}}})}}));
    }
    fs::path folder() const { return m_folder / GetParam().bytes; }
    fs::path scene() const { return folder() / (GetParam().bytes + ".glb"); }
    fs::path camera() const { return folder() / (GetParam().bytes + ".json"); }
    fs::path path() const { return folder() / (GetParam().bytes + ".path.json"); }
    fs::path out() const { return folder() / "out"; }

    void run(const std::string& command) {
        const Ended ended = runShell(command);
        ASSERT_EQ(ended.code, 0) << ended.error;
    }
    // All texts below --out are UTF-8; JSON can be read.
    void expectTexts(std::initializer_list<const char*> files) {
        for (const char* name : files) EXPECT_TRUE(fs::is_regular_file(out() / name)) << name;
        for (const auto& entry : fs::recursive_directory_iterator(out())) {
            const std::string extension = entry.path().extension().string();
            if (!entry.is_regular_file() || extension == ".png" || extension == ".exr") continue;
            const std::string text = textOf(entry.path());
            EXPECT_EQ(scene::utf8(text), text) << entry.path();
            if (extension != ".json") continue;
            EXPECT_FALSE(Json::parse(text, nullptr, false).is_discarded()) << entry.path();
        }
    }
    TemporaryFolder m_folder;
};

TEST_P(Names, evaluate) {
    run(
        shellCommand("{} --scene {} --camera {} --size 48x27 --rays 32 --frames 1 --json rows.json --capture-out frame --gallery page.html "
                     "--method hbao --out {}",
            OBSCURA_EVALUATE, scene(), camera(), out()));
    expectTexts({"metrics.json", "metrics.md", "rows.json", "page.html", "frame.json", "frame.capture.exr"});
    EXPECT_FALSE(fs::exists("rows.json"));
}

TEST_P(Names, gallery) {
    run(shellCommand("{} --scene {} --camera {} --size 48x27 --rays 32 --frames 1 --method hbao --out {} --gallery", OBSCURA_EVALUATE,
        scene(), camera(), out()));
    expectTexts({"gallery.html", "metrics.json"});
    EXPECT_FALSE(fs::exists("gallery.html"));
}

TEST_P(Names, capturedFrame) {
    const std::string name = GetParam().bytes;
    run(shellCommand("{} --scene {} --camera {} --size 48x27 --rays 32 --frames 1 --capture-out {}", OBSCURA_EVALUATE, scene(), camera(),
        folder() / (name + "-frame")));
    run(shellCommand("{} --capture {} --camera {} --rays 32 --frames 1 --out {}", OBSCURA_EVALUATE,
        folder() / (name + "-frame.capture.exr"), folder() / (name + "-frame.json"), out()));
    expectTexts({"metrics.json"});
}

TEST_P(Names, bench) {
    run(shellCommand(
        "{} --scene {} --camera {} --size 48x27 --rays 32 --frames 1 --rounds 3 --flicker 0 --no-gpu-cost --method hbao --out {}",
        OBSCURA_BENCH, scene(), camera(), out()));
    expectTexts({"bench.json", "bench.csv", "bench.md", "bench.html"});
    run(shellCommand("{} --from {} --compare {}", OBSCURA_BENCH, out() / "bench.json", out() / "bench.json"));
}

TEST_P(Names, flythrough) {
    run(shellCommand("{} --flythrough {} --size 48x27 --rays 32 --length 2 --method hbao --modes raw --no-video --out {}",
        OBSCURA_FLYTHROUGH, path(), out()));
    expectTexts({"report.json", "report.md", "report.html", "frames.csv"});
}

TEST_P(Names, tune) {
    run(shellCommand(
        "{} --size 48x27 --rays 32 --frames 2 --evaluations 4 --rounds 3 --method hbao --parameters steps --falloff quadratic:2 "
        "--train {} --held-out {} --out {}",
        OBSCURA_TUNE, path().string() + "@0", path().string() + "@1", out()));
    expectTexts({"tune.json", "tune.md"});
}

TEST_P(Names, game) {
    run(shellCommand("{} --headless --scene {} --camera {} --size 48x27 --measure --out {} --screenshot last.png", OBSCURA_GAME, scene(),
        camera(), out()));
    expectTexts({"timings.json", "summary.html", "measures.csv", "frame_0000.png", "last.png"});
    EXPECT_FALSE(fs::exists("last.png"));
}

INSTANTIATE_TEST_SUITE_P(
    Inputs, Names, testing::ValuesIn(kNames), [](const testing::TestParamInfo<Name>& info) { return std::string(info.param.what); });

}  // namespace
}  // namespace obscura::test
