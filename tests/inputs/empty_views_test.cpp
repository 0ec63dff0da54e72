// Views that show little or nothing, through every program that draws: a row without numbers, or one line and an exit code; never a crash.
#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "tools.h"

namespace obscura::test {
namespace {

enum class Shows { nothing, something, refused };

struct View {
    const char* name;
    Shows shows;
    std::string camera, options;  // the camera of a file; more options of the programs that have them
    GltfBuilder (*scene)();
};
void PrintTo(const View& view, std::ostream* out) { *out << view.name; }

GltfBuilder room() { return roomScene(); }
GltfBuilder masked() {
    GltfBuilder b = roomScene();
    b.json["materials"] = Json::array({{{"alphaMode", "MASK"}}});
    for (Json& mesh : b.json["meshes"]) mesh["primitives"][0]["material"] = 0;
    return b;
}
GltfBuilder empty() {
    GltfBuilder b;
    b.json["nodes"] = Json::array({{{"name", "nothing"}}});
    b.json["scenes"] = Json::array({{{"nodes", Json::array({0})}}});
    return b;
}
// With 16 x 16 pixels the triangle covers the centre of the pixel right of and below the picture's centre, 1 m ahead. A large one lies
// behind the camera, so that the scene is not taken for one in kilometres.
GltfBuilder onePixel() {
    GltfBuilder b;
    b.mesh({{"POSITION", b.vec3({0.006f, -0.066f, 0, 0.066f, -0.066f, 0, 0.036f, -0.006f, 0, -1, 0, 3, 1, 0, 3, 0, 1, 3})}});
    return b;
}

const std::string kAhead = R"({"eye":[0,0,1],"target":[0,0,0]})", kFront = R"({"eye":[0,2,4],"target":[0,0.5,0]})",
                  kUp = R"({"eye":[0,3,0],"target":[0,9,0.001],"verticalFovDegrees":30})",
                  kFar = R"({"eye":[0,20000,0],"target":[0,0,0],"verticalFovDegrees":1})";

const View kViews[] = {
    {"sky", Shows::nothing, kUp, "--size 48x27", room},
    {"far", Shows::nothing, kFar, "--size 48x27", room},
    {"masked", Shows::nothing, kFront, "--size 48x27 --skip-masked", masked},
    {"empty", Shows::refused, kFront, "--size 48x27", empty},
    {"pixel", Shows::something, kAhead, "--size 16x16", onePixel},
};

class EmptyViews : public testing::TestWithParam<View> {
protected:
    void SetUp() override {
        const View& view = GetParam();
        write(scene(), view.scene().text());
        write(m_folder / "camera.json", view.camera);
        const Json camera = Json::parse(view.camera);
        Json key{{"time", 0}, {"eye", camera["eye"]}, {"target", camera["target"]}};
        if (camera.contains("verticalFovDegrees")) key["verticalFovDegrees"] = camera["verticalFovDegrees"];
        write(path(), Json{{"scene", scene().string()}, {"loop", false}, {"keys", Json::array({key})}}.dump());
    }
    fs::path scene() const { return m_folder / "scene.gltf"; }
    fs::path path() const { return m_folder / "flight.path.json"; }
    fs::path out() const { return m_folder / "out"; }
    bool skipsMasked() const { return GetParam().options.find("--skip-masked") != std::string::npos; }
    std::string options() const { return GetParam().options + " "; }

    // Exit code and lines on stderr are as the view requires.
    Ended run(const std::string& command) {
        const Ended ended = runShell(command);
        if (GetParam().shows == Shows::refused) {
            EXPECT_EQ(ended.code, 2) << ended.error;
            EXPECT_EQ(ended.errorLines(), 1u) << ended.error;
        } else {
            EXPECT_EQ(ended.code, 0) << command << "\n" << ended.out << ended.error;
        }
        return ended;
    }
    bool drawn() const { return GetParam().shows != Shows::refused; }
    bool numbers() const { return GetParam().shows == Shows::something; }
    std::vector<std::string> linesOf(const fs::path& file) const {
        std::istringstream in(textOf(file));
        std::vector<std::string> lines;
        for (std::string line; std::getline(in, line);) lines.push_back(line);
        return lines;
    }
    TemporaryFolder m_folder;
};

TEST_P(EmptyViews, evaluate) {
    for (const char* more : {"--reference world,screen", "--reference screen --every 7 --method hbao,none", "--gallery --rays 32"}) {
        const Ended ended = run(shellCommand("{} --scene {} --camera {} --frames 1 --warm-up 0 --rays 32 --out {} --json {} ",
                                    OBSCURA_EVALUATE, scene(), m_folder / "camera.json", out(), m_folder / "rows.json") +
                                options() + more + (std::string(more).starts_with("--gallery") ? " --method hbao,gtao" : ""));
        if (!drawn()) continue;
        const Json rows = Json::parse(textOf(m_folder / "rows.json"));
        ASSERT_FALSE(rows.empty());
        const bool every = std::string(more).find("--every") != std::string::npos;
        if (every) continue;
        for (const Json& row : rows) {
            EXPECT_EQ(row.contains("eA"), numbers()) << row;
            EXPECT_EQ(row["pixels"].get<int>(), numbers() ? 1 : 0) << row;
        }
        if (!numbers()) {
            EXPECT_NE(ended.out.find("no surface is nearer than 10000 m: no errors"), std::string::npos) << ended.out;
        }
        EXPECT_EQ(ended.out.find("nan"), std::string::npos) << ended.out;
        fs::remove_all(out());
    }
}

TEST_P(EmptyViews, evaluateACapturedFrame) {
    if (!drawn()) return;
    run(shellCommand("{} --scene {} --camera {} --method none --frames 1 --rays 32 --capture-out {} ", OBSCURA_EVALUATE, scene(),
            m_folder / "camera.json", m_folder / "frame") +
        options());
    const Ended ended = run(shellCommand("{} --capture {} --camera {} --frames 1 --rays 32 --json {}", OBSCURA_EVALUATE,
        m_folder / "frame.capture.exr", m_folder / "frame.json", m_folder / "rows.json"));
    const Json rows = Json::parse(textOf(m_folder / "rows.json"));
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].contains("eA"), numbers()) << rows;
}

TEST_P(EmptyViews, bench) {
    if (skipsMasked()) GTEST_SKIP() << "obscura-bench has no --skip-masked";
    run(shellCommand("{} --scene {} --camera {} --method hbao,none --frames 2 --rounds 1 --rays 32 --no-gpu-cost --out {} ", OBSCURA_BENCH,
            scene(), m_folder / "camera.json", out()) +
        options());
    if (!drawn()) return;
    const Json results = Json::parse(textOf(out() / "bench.json"));
    ASSERT_EQ(results["rows"].size(), 2u);
    for (const Json& row : results["rows"]) EXPECT_EQ(row["errors"].empty(), !numbers()) << row;
}

TEST_P(EmptyViews, flythrough) {
    if (skipsMasked()) GTEST_SKIP() << "obscura-flythrough has no --skip-masked";
    const Ended ended = run(shellCommand("{} --flythrough {} --method hbao --modes raw,temporal --length 3 --rays 32 --no-video --out {} ",
                                OBSCURA_FLYTHROUGH, path(), out()) +
                            options());
    if (!drawn()) return;
    const Json report = Json::parse(textOf(out() / "report.json"));
    ASSERT_EQ(report["parts"].size(), 2u);
    for (const Json& part : report["parts"]) {
        EXPECT_EQ(part.contains("eA"), numbers()) << part;
        for (const Json& frame : part["frames"]) EXPECT_EQ(frame.contains("eA"), numbers()) << part;
    }
    const std::vector<std::string> lines = linesOf(out() / "frames.csv");
    ASSERT_EQ(lines.size(), 1u + 2 * 3);
    for (const std::string& line : lines)
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), std::count(lines[0].begin(), lines[0].end(), ',')) << line;
    EXPECT_EQ(lines[1].ends_with(",,,,,,,,,"), !numbers()) << lines[1];
    EXPECT_EQ(ended.out.find("nan"), std::string::npos) << ended.out;
    // Chunks without numbers are read back.
    const Ended again = run(shellCommand("{} --merge {} --no-video --out {}", OBSCURA_FLYTHROUGH, out(), m_folder / "merged"));
    EXPECT_EQ(textOf(out() / "frames.csv"), textOf(m_folder / "merged/frames.csv"));
}

TEST_P(EmptyViews, tune) {
    if (skipsMasked()) GTEST_SKIP() << "obscura-tune has no --skip-masked";
    const Ended ended = runShell(shellCommand("{} --method hbao --train {} --held-out {} --falloff quadratic:2 --parameters steps ",
                                     OBSCURA_TUNE, path().string() + "@0", path().string() + "@1") +
                                 shellCommand("--frames 2 --rays 32 --evaluations 4 --rounds 3 --out {} ", out()) + options());
    if (numbers()) {
        EXPECT_EQ(ended.code, 0) << ended.error;
    } else {
        EXPECT_EQ(ended.code, 2) << ended.error;
        EXPECT_EQ(ended.errorLines(), 1u) << ended.error;
        EXPECT_NE(ended.error.find(drawn() ? "shows only sky" : "contains nothing to draw"), std::string::npos) << ended.error;
    }
}

TEST_P(EmptyViews, game) {
    for (const char* more : {"", "--measure --frames 3", "--compare gtao --view difference --frames 2", "--method hybrid --voxels 64"}) {
        const Ended ended =
            run(shellCommand("{} --headless --scene {} --camera {} --out {} ", OBSCURA_GAME, scene(), m_folder / "camera.json", out()) +
                options() + more);
        EXPECT_EQ(ended.out.find("nan"), std::string::npos) << ended.out;
        if (drawn()) {
            EXPECT_TRUE(fs::exists(out() / "frame_0000.png"));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Inputs, EmptyViews, testing::ValuesIn(kViews), [](const testing::TestParamInfo<View>& info) { return std::string(info.param.name); });

// Every 64th pixel of 96 x 54 meets only sky.
TEST(SparsePixels, thatMeetOnlySkyGiveRowsWithoutNumbers) {
    const TemporaryFolder folder;
    write(folder / "scene.glb", roomScene().binary());
    write(folder / "camera.json", R"({"eye":[0,1,12],"target":[0,0.5,0]})");
    const Ended ended = runShell(shellCommand("{} --scene {} --camera {} --size 96x54 --every 64 --frames 1 --rays 32 --json {} --out {}",
        OBSCURA_EVALUATE, folder / "scene.glb", folder / "camera.json", folder / "rows.json", folder / "out"));
    ASSERT_EQ(ended.code, 0) << ended.error;
    EXPECT_NE(ended.out.find("--every 64 meets only sky: no errors"), std::string::npos) << ended.out;
    EXPECT_FALSE(Json::parse(textOf(folder / "rows.json"))[0].contains("eA"));
}

}  // namespace
}  // namespace obscura::test
