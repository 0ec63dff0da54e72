// A wall on a floor against its exact obscurance, and the influence of the parameters there.
#include "far_field/fixture.h"

namespace obscura::test {
namespace {

// Obscurance of a floor point `a` metres from an infinite wall, exponential falloff of 1 m: (2/pi) int_0^1 e^(-a/m) sqrt(1 - m^2) dm.
double exactAtWall(double a) {
    const int n = 4000;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
        const double m = (i + 0.5) / n;
        sum += std::exp(-a / m) * std::sqrt(1.0 - m * m);
    }
    return sum * 2.0 / 3.14159265358979 / n;
}

TEST_F(FarFieldTest, infiniteWallMatchesTheExactValueAtEveryDistance) {
    for (const auto& [a, exact] : {std::pair{0.1, 0.34128}, {0.5, 0.13836}, {1.0, 0.05758}}) EXPECT_NEAR(exactAtWall(a), exact, 1e-4);
    const Room room = crease();  // the image cuts off the ends of the wall, 0.01; interleaving is less accurate at the crease
    struct Case {
        const char* preset;
        double tolerance;
    };
    for (const auto& [preset, tolerance] : {Case{"default", 0.018}, Case{"fast", 0.07}, Case{"paper_16x2", 0.04}}) {
        const Picture picture = run(room, values({}, preset), "exponential:1");
        int rows = 0;
        for (uint32_t y = 0; y < room.visibleHeight(); ++y) {
            const size_t i = size_t(y + room.guard) * room.width + room.width / 2;
            const double a = -room.wall - room.depth[i];
            if (room.normals[4 * i + 1] < 0.5f || a < 0.06 || a > 1.5) continue;
            EXPECT_NEAR(rowMean(room, picture, y), exactAtWall(a), tolerance) << preset << " " << a << " m from the wall";
            ++rows;
        }
        EXPECT_GT(rows, 20);
    }
}

// One scan serves two opposite directions, each with its own second height: rotating the image by half a turn changes nothing.
TEST_F(FarFieldTest, rotationByHalfATurnChangesNothing) {
    const Room room = crease();
    Room turned = room;
    std::reverse(turned.depth.begin(), turned.depth.end());
    const size_t pixels = turned.depth.size();
    for (size_t i = 0; i < pixels; ++i)
        for (int c = 0; c < 3; ++c) turned.normals[4 * i + c] = (c < 2 ? -1.0f : 1.0f) * room.normals[4 * (pixels - 1 - i) + c];
    for (const char* preset : {"default", "paper_16x2", "paper_saao"}) {
        const Picture straight = run(room, values({}, preset), "exponential:1");
        Picture back = run(turned, values({}, preset), "exponential:1");
        std::reverse(back.begin(), back.end());
        double difference = 0.0;
        for (size_t i = 0; i < back.size(); ++i) difference += std::abs(double(back[i]) - double(straight[i]));
        EXPECT_LT(difference / double(back.size()), preset == std::string("paper_saao") ? 0.004 : 0.0015) << preset;
        EXPECT_GT(mean(straight), 0.05);
    }
}

TEST_F(FarFieldTest, oddNumberOfDirectionsMatchesEven) {
    const Room room = crease();
    const double even = mean(run(room, values({{"directions", 8}}), "exponential:1")),
                 odd = mean(run(room, values({{"directions", 9}}), "exponential:1"));
    EXPECT_NEAR(odd, even, 0.03 * even);
}

TEST_F(FarFieldTest, parametersDoNotChangeTheLimit) {
    const Room room = crease();
    const double limit = mean(run(room, values({{"directions", 32}, {"segments", 4}, {"near", 16}}), "exponential:1"));
    EXPECT_GT(limit, 0.05);
    const auto check = [&](const Changes& changes, const char* preset, double tolerance) {
        EXPECT_NEAR(mean(run(room, values(changes, preset), "exponential:1")), limit, tolerance * limit)
            << preset << " " << changes[0].id << " " << changes[0].value;
    };
    for (const float k : {4.0f, 7.0f, 16.0f, 32.0f}) check({{"directions", k}}, "default", k < 8.0f ? 0.1 : 0.05);
    for (const float s : {1.0f, 3.0f, 8.0f}) check({{"segments", s}}, "default", 0.06);
    for (const float b : {3.0f, 7.0f, 20.0f}) check({{"interval", b}, {"near", 8}}, "default", 0.08);
    for (const float l : {0.0f, 1.0f, 2.0f}) check({{"lines", l}}, "default", 0.05);
    for (const float e : {0.0f, 1.0f, 2.0f}) check({{"estimator", e}}, "default", 0.12);
    for (const float a : {0.0f, 1.0f, 2.0f}) check({{"averaging", a}}, "default", 0.05);
    for (const float s : {-1.0f, -0.5f, 0.5f, 1.0f, 2.0f}) check({{"slope", s}}, "default", 0.08);
    for (const float s : {0.0f, 1.0f}) check({{"interleave", 2 * s}, {"directions", 18}, {"segments", 2}}, "default", 0.08);
}

TEST_F(FarFieldTest, nearAndFarFieldAddUp) {
    const Room room = crease();
    const Picture both = run(room, values({}), "exponential:1"), near = run(room, values({{"parts", 1}}), "exponential:1"),
                  far = run(room, values({{"parts", 2}}), "exponential:1");
    for (size_t i = 0; i < both.size(); ++i) ASSERT_NEAR(near[i] + far[i], both[i], 0.002) << i;
    EXPECT_GT(mean(near), 0.002);
    EXPECT_GT(mean(far), 0.03);
    EXPECT_GT(
        mean(run(room, values({{"near", 0}}), "exponential:1")), mean(far));  // without the near field, nothing hides distant occluders
}

TEST_F(FarFieldTest, presetsRunTheirPasses) {
    const Room room = crease();
    const auto ran = [&](const char* preset, std::initializer_list<const char*> with, std::initializer_list<const char*> without) {
        run(room, values({}, preset), "exponential:1");
        const std::string plan = m_executor->plan().text(m_graph->recording());
        for (const char* pass : with) EXPECT_NE(plan.find(std::string("far_field.") + pass), std::string::npos) << preset << " " << pass;
        for (const char* pass : without) EXPECT_EQ(plan.find(std::string("far_field.") + pass), std::string::npos) << preset << " " << pass;
    };
    ran("default", {"scan", "pyramid", "obscurance"}, {"prefix sums", "blur"});
    ran("paper_8x2", {"scan", "prefix sums", "obscurance"}, {"pyramid", "blur"});
    ran("paper_saao", {"scan", "prefix sums", "near field", "box average", "obscurance", "blur"}, {"pyramid"});
}

TEST_F(FarFieldTest, everyPresetIsDeterministic) {
    const Room room = crease(160, 120, 16);
    for (const ao::Preset& preset : ao::findMethod("far_field")->presets)
        EXPECT_EQ(run(room, values({}, preset.id), "exponential:1"), run(room, values({}, preset.id), "exponential:1")) << preset.id;
}

}  // namespace
}  // namespace obscura::test
