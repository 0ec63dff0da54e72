// Cameras of glTF files: in any unit, perspective with and without a far plane, orthographic from 0 on, below scaled nodes.
#include <cmath>

#include <gtest/gtest.h>

#include "scene/camera.h"
#include "tools.h"
#include "truth/captured_frame.h"

namespace obscura::test {
namespace {

constexpr float kRoom = 5.0f;  // the room's floor has 40 m

// The lenses in metres, in a file of other units; all stand 30 m before the block and 18 m above the floor, and look at the block.
GltfBuilder roomWithCameras(float unit) {
    GltfBuilder b = roomScene(kRoom * unit);
    const auto perspective = [&](Json lens) { return Json{{"type", "perspective"}, {"perspective", lens}}; };
    const auto orthographic = [&](float near, float far) {
        return Json{{"type", "orthographic"},
            {"orthographic", {{"xmag", 24 * unit}, {"ymag", 13.5 * unit}, {"znear", near * unit}, {"zfar", far * unit}}}};
    };
    b.json["cameras"] = Json::array({perspective({{"yfov", 0.9}, {"znear", 0.5 * unit}, {"zfar", 200 * unit}}),
        perspective({{"yfov", 0.9}, {"znear", 0.5 * unit}}), orthographic(0, 100), orthographic(0.001f, 100), orthographic(0.01f, 100),
        orthographic(0.1f, 100), orthographic(0, 37), perspective({{"yfov", 0.9}, {"znear", 0.5 * unit}, {"zfar", 37 * unit}})});
    Json& nodes = b.json["nodes"];
    Json& roots = b.json["scenes"][0]["nodes"];
    const Json turn{-0.2588190451, 0, 0, 0.9659258263};  // 30 degrees down
    for (size_t i = 0; i < b.json["cameras"].size(); ++i) {
        roots.push_back(nodes.size());
        nodes.push_back({{"camera", i}, {"translation", {0, 18 * unit, 30 * unit}}, {"rotation", turn}});
    }
    // The first lens again, below a node that scales by 4: the place is scaled, the lens is not [glTF 2.0, 3.10].
    nodes.push_back({{"camera", 1}, {"translation", {0, 4.5 * unit, 7.5 * unit}}, {"rotation", turn}});
    roots.push_back(nodes.size());
    nodes.push_back({{"scale", {4, 4, 4}}, {"children", {nodes.size() - 1}}});
    return b;
}
enum Lens { kFinite, kInfinite, kFromZero, kFromMillimetre, kFromCentimetre, kFromDecimetre, kOrthoNear, kNear, kScaled };

class FileCameras : public testing::Test {
protected:
    void SetUp() override {
        for (const auto& [name, unit] : {std::pair("metres", 1.0f), std::pair("millimetres", 1000.0f), std::pair("kilometres", 0.001f)})
            write(file(name), roomWithCameras(unit).binary());
    }
    fs::path file(const std::string& name) const { return m_folder / (name + ".glb"); }
    truth::CapturedFrame capture(const std::string& name, int lens) {
        const Ended ended =
            runShell(shellCommand("{} --scene {} --camera {} --size 96x54 --guard 0 --method hbao --rays 32 --frames 1 "
                                  "--reference screen --capture-out {} --json {}",
                OBSCURA_EVALUATE, file(name), "scene:" + std::to_string(lens), m_folder / "frame", m_folder / "rows.json"));
        EXPECT_EQ(ended.code, 0) << ended.error;
        m_row = Json::parse(textOf(m_folder / "rows.json"))[0];
        return truth::readCapture(m_folder / "frame");
    }
    size_t surfaces(const truth::CapturedFrame& frame) {
        size_t count = 0;
        for (size_t i = 0; i < frame.depth.size(); ++i) count += !frame.isSky(i);
        return count;
    }
    // The same surfaces at `scale` times the depths, but for pixels at edges.
    void expectSame(const truth::CapturedFrame& a, const truth::CapturedFrame& b, float scale, const std::string& what) {
        ASSERT_EQ(a.depth.size(), b.depth.size());
        size_t differ = 0;
        for (size_t i = 0; i < a.depth.size(); ++i)
            differ += a.isSky(i) != b.isSky(i) || (!a.isSky(i) && std::fabs(a.depth[i] * scale - b.depth[i]) > 2e-3f * b.depth[i]);
        EXPECT_LT(differ, a.depth.size() / 100) << what;
        EXPECT_GT(surfaces(a), a.depth.size() / 3) << what;
    }
    TemporaryFolder m_folder;
    Json m_row;
};

TEST_F(FileCameras, showTheSameInEveryUnit) {
    for (const Lens lens : {kFinite, kInfinite, kFromZero, kScaled, kOrthoNear}) {
        const truth::CapturedFrame metres = capture("metres", lens);
        EXPECT_GT(m_row["eA"].get<float>(), 0.0f) << m_row;
        expectSame(capture("millimetres", lens), metres, 1.0f, "millimetres, lens " + std::to_string(lens));
        // 57 m are plausible, .057 m are shown at ten times their size.
        expectSame(capture("kilometres", lens), metres, 100.0f, "kilometres, lens " + std::to_string(lens));
    }
}

TEST_F(FileCameras, orthographicFromZeroOn) {
    const truth::CapturedFrame first = capture("metres", kFromZero);
    EXPECT_NEAR(first.depth[first.index(48, 40)], 30.0f, 10.0f);
    for (const Lens lens : {kFromMillimetre, kFromCentimetre, kFromDecimetre})
        expectSame(capture("metres", lens), first, 1.0f, "lens " + std::to_string(lens));
}

TEST_F(FileCameras, farPlanesCut) {
    for (const auto& [cut, whole] : {std::pair(kOrthoNear, kFromZero), std::pair(kNear, kInfinite)}) {
        const truth::CapturedFrame all = capture("metres", whole), part = capture("metres", cut);
        size_t beyond = 0;
        for (size_t i = 0; i < all.depth.size(); ++i) {
            if (all.isSky(i)) continue;
            beyond += all.depth[i] > 37.2f;
            if (all.depth[i] < 36.8f) {
                EXPECT_NEAR(part.depth[i], all.depth[i], 2e-3f * all.depth[i]);
            } else if (all.depth[i] > 37.2f) {
                EXPECT_TRUE(part.isSky(i));
            }
        }
        EXPECT_GT(beyond, 100u);
    }
}

TEST_F(FileCameras, scaledParentsPlaceTheLensAndDoNotScaleIt) {
    expectSame(capture("metres", kScaled), capture("metres", kInfinite), 1.0f, "below a scaled node");
}

TEST_F(FileCameras, theGameShowsThemInEveryUnitAndSaysWhenTheyShowNothing) {
    const auto picture = [&](const std::string& name, const std::string& camera, std::string* said = nullptr) {
        const Ended ended = runShell(shellCommand("{} --headless --scene {} --camera {} --size 96x54 --view normals --screenshot {}",
            OBSCURA_GAME, file(name), camera, m_folder / "picture.png"));
        EXPECT_EQ(ended.code, 0) << ended.error;
        if (said) *said = ended.error;
        return textOf(m_folder / "picture.png");
    };
    std::string said;
    for (const char* camera : {"scene:0", "scene:2"}) {
        const std::string metres = picture("metres", camera, &said);
        EXPECT_EQ(said.find("shows only sky"), std::string::npos) << said;
        picture("millimetres", camera, &said);
        EXPECT_EQ(said.find("shows only sky"), std::string::npos) << said;
        picture("kilometres", camera, &said);
        EXPECT_EQ(said.find("shows only sky"), std::string::npos) << said;
    }
    write(m_folder / "up.json", R"({"eye":[0,30,0],"target":[0,90,1]})");
    picture("metres", (m_folder / "up.json").string(), &said);
    EXPECT_NE(said.find("shows only sky"), std::string::npos) << said;
}

}  // namespace
}  // namespace obscura::test
