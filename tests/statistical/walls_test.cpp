// A wall behind a floor against the values of an independent implementation, and the influence of the parameters there.
#include <random>

#include "statistical/fixture.h"

namespace obscura::test {
namespace {

// Floor 1.5 m below the camera, wall 8 m ahead, 320 x 180 px visible.
Room hall() {
    Room room = crease(384, 216, 18, -1.5f, -8.0f);
    // The guard band is 32 px to the left and right; that of Room is equal on all sides.
    const float f = 1.0f / std::tan(0.5236f);
    room.projection[5] = -f * 180.0f / 216.0f;
    room.projection[0] = f * 180.0f / 384.0f;
    return room;
}
ao::Frame frameOf(const Room& room) {
    ao::Frame frame = room.frame();
    frame.guard = {32, 18};
    return frame;
}

class Hall : public StatisticalTest {
protected:
    Picture run(const ao::Values& values) { return StatisticalTest::run(m_room, frameOf(m_room), values, "quadratic:1"); }
    static double row(const Picture& picture, uint32_t y) {  // mean over the middle of the row
        double sum = 0.0;
        for (uint32_t x = 150; x < 170; ++x) sum += picture[size_t(y) * 320 + x];
        return sum / 20.0;
    }
    const Room m_room = hall();
};

TEST_F(Hall, matchesTheIndependentImplementation) {
    const Picture picture = run(values({{"radius", 0.75f}, {"height", 1.5f}, {"slope", 4}, {"gain", 1}, {"largest", 0.25f}}, "quality"));
    for (const auto& [y, expected] :
        {std::pair{119u, 0.1216}, {120u, 0.1097}, {121u, 0.0987}, {123u, 0.0796}, {117u, 0.1242}, {114u, 0.1531}, {109u, 0.0673}})
        EXPECT_NEAR(row(picture, y), expected, 5e-4) << "row " << y;
}

TEST_F(Hall, matchesWithoutQuadrantsInASmallBox) {
    const Changes small = {{"gain", 1}, {"radius", 0.5f}, {"height", 0.5f}, {"slope", 1}, {"quadrants", 0}};
    const Picture four = run(values(small, "quality"));
    for (const auto& [y, expected] : {std::pair{119u, 0.2390}, {120u, 0.2001}, {121u, 0.1653}, {123u, 0.1096}, {117u, 0.1145}})
        EXPECT_NEAR(row(four, y), expected, 1e-3) << "row " << y;
    Changes one = small;
    one.push_back({"layers", kOne});
    EXPECT_NEAR(row(run(values(one, "quality")), 117), 0.7665, 2e-3);  // with one layer the floor in front is averaged in
}

TEST_F(Hall, quadrantsChangeTheResultAndPointsAgree) {
    const Picture whole = run(values({}, "paper")), quarters = run(values({}, "quality")),
                  points = run(values({{"estimator", kPoints}}, "quality"));
    EXPECT_NE(whole, quarters);
    double difference = 0.0;
    for (size_t i = 0; i < points.size(); ++i) difference += std::abs(points[i] - quarters[i]);
    EXPECT_LT(difference / double(points.size()), 0.02);
}

TEST_F(Hall, linesConvergeToPoints) {
    const Picture many = run(values({{"estimator", kPoints}, {"samples", 1024}})),
                  lines = run(values({{"estimator", kLines}, {"samples", 64}}));
    double difference = 0.0;
    for (size_t i = 0; i < many.size(); ++i) difference += std::abs(many[i] - lines[i]);
    EXPECT_LT(difference / double(many.size()), 0.01);
    EXPECT_GT(mean(lines), 0.015);
}

TEST_F(Hall, adaptiveLayersConvergeToUniformOnes) {
    const Picture uniform = run(values({{"layers", kUniform64}}, "quality"));
    double before = 1.0;
    for (const Layering layering : {kOne, kTwo, kFour, kEight}) {
        const Picture adaptive = run(values({{"layers", float(layering)}}, "quality"));
        double difference = 0.0;
        for (size_t i = 0; i < uniform.size(); ++i) difference += std::abs(adaptive[i] - uniform[i]);
        EXPECT_LT(difference, before * double(uniform.size())) << layering;
        before = difference / double(uniform.size()) + 1e-4;
    }
    EXPECT_LT(before, 0.01);
}

TEST_F(StatisticalTest, planesAreOpen) {
    for (const auto& normal :
        {std::array{0.0f, 1.0f, 0.0f}, std::array{0.0f, 0.0f, 1.0f}, std::array{0.5f, 1.0f, 0.05f}, std::array{-0.7f, 0.1f, 0.7f}}) {
        const Room room = plane(normal, 6.0f);  // farther away the error of the packed normal, 0.004 degrees, is visible
        for (const char* preset : {"default", "paper", "quality"}) {
            EXPECT_LT(highest(run(room, values({}, preset))), 5e-4f) << preset;  // visibility is 1, or the half float next to 1
        }
    }
}

TEST_F(StatisticalTest, resultIsIndependentOfTheFrameIndex) {
    Room room;
    room.wall = -4.0f;
    room.build();
    for (const ao::Preset& preset : ao::findMethod("statistical")->presets) {
        ao::Frame one = room.frame(), other = room.frame();
        one.index = 1;
        other.index = 12345;
        EXPECT_EQ(run(room, one, values({}, preset.id), "quadratic:1"), run(room, other, values({}, preset.id), "quadratic:1"))
            << preset.id;
    }
}

TEST_F(StatisticalTest, limitedWindowScalesTheBox) {
    // Orthographic, 5 cm per px, so that all windows have the same width: 16 px, limited to 8.8 px.
    Room room;
    room.build();
    const float scale = 2.0f / 0.05f;
    const float orthographic[16] = {scale / float(room.width), 0, 0, 0, 0, -scale / float(room.height), 0, 0, 0, 0, -0.01f, 0, 0, 0, 0, 1};
    std::memcpy(room.projection, orthographic, sizeof(orthographic));
    std::mt19937 random(3);
    for (size_t i = 0; i < room.depth.size(); ++i) {
        room.depth[i] = 4.0f + float(random() % 100) * 0.004f;
        room.normals[4 * i + 1] = 0.0f;
        room.normals[4 * i + 2] = 1.0f;
    }
    const Picture wide = run(room, values({{"radius", 0.8f}, {"height", 1}, {"largest", 0.11f}})),
                  narrow = run(room, values({{"radius", 0.44f}, {"height", 0.55f}}));
    EXPECT_GT(mean(narrow), 0.05);
    double difference = 0.0;
    for (size_t i = 0; i < wide.size(); ++i) difference = std::max(difference, std::abs(double(wide[i]) - narrow[i]));
    EXPECT_LT(difference, 0.002);
}

TEST_F(StatisticalTest, boxScalesWithTheFalloff) {
    Room room;
    room.wall = -4.0f;
    room.build();
    EXPECT_EQ(run(room, values({{"radius", 1.5f}, {"height", 3.0f}}), "quadratic:1"),
        run(room, values({{"radius", 0.75f}, {"height", 1.5f}}), "quadratic:2"));
    double before = 0.0;
    for (const char* falloff : {"linear:0.5", "linear:1", "wendland:2", "linear:2"}) {
        const double now = mean(run(room, values({}), falloff));
        EXPECT_GT(now, before) << falloff;
        before = now;
    }
}

}  // namespace
}  // namespace obscura::test
