// A wall behind a floor against the values of an independent implementation, and the influence of the parameters there.
#include <random>

#include "offscreen/tall_box.h"
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

// The largest window bounds the fixed point: at 1920 x 1080 px these distances are 10 km and 2 km.
TEST_F(StatisticalTest, onePixelFarAwayDoesNotSpoilTheOthers) {
    for (const bool orthographic : {false, true})
        for (const float far : {4e4f, 8e3f}) {
            Room room;
            room.width = 960;
            room.height = 540;
            room.guard = 0;
            room.build();
            room.bits.clear();
            room.volume = {};
            if (orthographic) {
                const float scale = 2.0f / 5.0f;  // 5 m high
                const float p[16] = {scale * 540.0f / 960.0f, 0, 0, 0, 0, -scale, 0, 0, 0, 0, -1e-6f, 0, 0, 0, 0, 1};
                std::memcpy(room.projection, p, sizeof(p));
            }
            for (size_t i = 0; i < room.depth.size(); ++i) {
                room.depth[i] = (orthographic ? 1000.0f : 0.0f) + 2.3f;
                room.normals[4 * i + 1] = 0.0f;
                room.normals[4 * i + 2] = 1.0f;
            }
            room.depth[0] = far;
            ao::Frame frame = room.frame();
            frame.skyDepth = 1e5f;
            for (const char* preset : {"default", "paper"}) {
                const Picture picture = run(room, frame, values({}, preset), "quadratic:1");
                EXPECT_LT(highest(picture), 0.002f) << preset << ", " << far << " m, orthographic: " << orthographic;
            }
        }
}

// Windows of which a half is sky, and a quarter a block above the floor: sky is as open as a wall 100 m behind.
TEST_F(StatisticalTest, skyIsAsOpenAsADistantWall) {
    const auto scene = [](float behind) {
        Room room;
        room.build();
        for (uint32_t y = 0; y < room.height; ++y)
            for (uint32_t x = 0; x < room.width; ++x) {
                const size_t i = size_t(y) * room.width + x;
                room.depth[i] = x >= room.width / 2 ? behind : y < room.height / 2 ? 2.6f : 3.0f;
                room.normals[4 * i + 1] = 0.0f;
                room.normals[4 * i + 2] = 1.0f;
            }
        return room;
    };
    const Room sky = scene(1e4f), wall = scene(100.0f);
    std::vector<std::pair<std::string, ao::Values>> all;
    for (const char* preset : {"default", "paper", "quality", "paper_half", "paper_quarter"}) all.push_back({preset, values({}, preset)});
    for (const Estimator estimator : {kPoints, kLines})
        all.push_back({estimator == kPoints ? "points" : "lines", values({{"estimator", float(estimator)}})});
    for (const Layering layers : {kTwo, kEight, kUniform16})
        all.push_back({"layers " + std::to_string(layers), values({{"layers", float(layers)}})});
    for (const auto& [name, of] : all) {
        const Picture before = run(sky, of), distant = run(wall, of);
        float most = 0.0f, highest = 0.0f;
        for (uint32_t y = 0; y < sky.visibleHeight(); ++y)
            for (uint32_t x = 0; x < sky.visibleWidth() / 2 - 2; ++x) {
                const size_t i = size_t(y) * sky.visibleWidth() + x;
                most = std::max(most, std::abs(before[i] - distant[i]));
                highest = std::max(highest, before[i]);
            }
        EXPECT_GT(highest, 0.1f) << name;
        EXPECT_LT(most, 0.01f) << name;
    }
}

// A box hidden by a panel 3.5 m before it, which is higher than the method's box and so blocks nothing: the off-screen pass adds the box.
TEST_F(StatisticalTest, boxHiddenByADistantPanelIsAdded) {
    TallBox box({-0.6, TallBox::kFloor, -7.0}, {0.6, 0.5, -5.5});
    box.turnTo(0.0);
    for (uint32_t y = 0; y < box.height; ++y)
        for (uint32_t x = 0; x < box.width; ++x) {
            const TallBox::Point d = box.direction(x + 0.5, y + 0.5);
            const size_t i = size_t(y) * box.width + x;
            int axis = 0;
            if (std::abs(box.hit({0, 0, 0}, d, axis) - double(box.depth[i])) > 1e-3) continue;
            box.depth[i] = 2.0f;
            box.normals[4 * i] = box.normals[4 * i + 1] = 0.0f;
            box.normals[4 * i + 2] = 1.0f;
        }
    const TallBox::Point p{-0.75, TallBox::kFloor, -6.2};
    const auto at = box.pixelOf(p);
    const auto obscurance = [&](float offscreen) {
        return double(
            run(box, box.seen(), values({{"offscreen", offscreen}}), "quadratic:2").at(size_t(at[1]) * box.visibleWide() + size_t(at[0])));
    };
    const double exact = box.truth(p, {}), alone = obscurance(0), hidden = obscurance(2);
    printf("beside a hidden box: exact %.3f, alone %.3f, with hidden occluders %.3f\n", exact, alone, hidden);
    EXPECT_LT(alone, 0.6 * exact);
    EXPECT_NEAR(hidden - alone, exact, 0.06);
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

// Along the view a wall that faces the camera is as along its normal, whatever its normals; a slanted floor darkens itself.
TEST_F(StatisticalTest, viewAlignedBoxesNeedNoNormals) {
    const Changes view = {{"align", 1}};
    for (const Estimator estimator : {kTables, kPoints, kLines})
        for (const Layering layers : {kFour, kUniform16}) {
            if (estimator != kTables && layers != kFour) continue;
            Changes along = {{"estimator", float(estimator)}, {"layers", float(layers)}};
            Room facing = plane({0, 0, 1});
            for (uint32_t y = 40; y < 60; ++y)
                for (uint32_t x = 60; x < 100; ++x) facing.depth[size_t(y) * facing.width + x] = 1.2f;
            const Picture normal = run(facing, values(along));
            along.push_back(view[0]);
            const Picture aligned = run(facing, values(along));
            float most = 0.0f;
            for (size_t i = 0; i < normal.size(); ++i) most = std::max(most, std::abs(normal[i] - aligned[i]));
            EXPECT_LT(most, 0.001f) << estimator << ", " << layers;
            EXPECT_GT(highest(aligned), 0.1f);
            for (size_t i = 0; i < facing.depth.size(); ++i) facing.normals[4 * i] = 0.6f, facing.normals[4 * i + 2] = 0.8f;
            if (estimator != kLines) {  // the blur of lines needs them
                EXPECT_EQ(run(facing, values(along)), aligned);
            }
            EXPECT_GT(mean(run(plane({0, 1, 0}, 20.0f), values(along))), 0.02);
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
