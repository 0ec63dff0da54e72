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

// At every pixel settings are near the limit of many directions, short intervals and no averages; what is finer is nearer. The error is a
// mean over pixels of absolute differences; the obscurance is 0.1.
TEST_F(FarFieldTest, settingsConvergeToOneLimit) {
    const Room room = crease();
    const Changes fine{
        {"directions", 32}, {"segments", 8}, {"averaging", 0}, {"interval", 3}, {"longest", 0.25f}, {"near", 16}, {"alternate", 0}};
    const Picture limit = run(room, values(fine), "exponential:1");
    EXPECT_GT(mean(limit), 0.05);
    const auto error = [&](const Changes& changes, const char* preset = "default") {
        const Picture picture = run(room, values(changes, preset), "exponential:1");
        double sum = 0.0;
        for (size_t i = 0; i < limit.size(); ++i) sum += std::abs(double(picture[i]) - double(limit[i]));
        return sum / double(limit.size());
    };
    struct Ladder {
        const char* preset;
        const char* parameter;
        std::vector<std::pair<float, double>> steps;  // value, largest error; from coarse to fine
    };
    const Ladder ladders[] = {
        {"default", "directions", {{4, 0.006}, {7, 0.0024}, {16, 0.002}}},
        {"default", "segments", {{1, 0.0028}, {3, 0.0021}, {8, 0.002}}},
        {"default", "interval", {{20, 0.0036}, {7, 0.002}, {3, 0.002}}},
        {"default", "longest", {{1, 0.0045}, {0.5f, 0.0021}, {0.25f, 0.0007}}},
        {"default", "lines", {{2, 0.0022}, {1, 0.0021}, {0, 0.0021}}},
        {"default", "estimator", {{0, 0.0075}, {2, 0.0021}}},
        {"default", "averaging", {{3, 0.0036}, {2, 0.0021}, {0, 0.002}}},
        {"default", "slope", {{-1, 0.0024}, {1, 0.0021}}},
        {"default", "near", {{2, 0.0025}, {5, 0.0021}, {16, 0.0019}}},
        {"paper_8x2", "interval", {{20, 0.013}, {10, 0.0125}, {5, 0.012}}},
        {"paper_8x2", "longest", {{1, 0.0125}, {0.5f, 0.008}, {0.25f, 0.006}}},
    };
    for (const auto& [preset, parameter, steps] : ladders) {
        double before = 1.0;
        for (const auto& [value, most] : steps) {
            const double now = error({{parameter, value}}, preset);
            EXPECT_LT(now, most) << preset << ", " << parameter << " " << value;
            EXPECT_LT(now, before) << preset << ", " << parameter << " " << value;
            before = now;
        }
    }
    for (const float slope : {-2.0f, -0.5f, 0.5f, 2.0f}) EXPECT_LT(error({{"slope", slope}}), 0.0024) << slope;
    for (const float side : {1.0f, 2.0f, 3.0f})
        EXPECT_LT(error({{"interleave", side}, {"directions", 18}, {"segments", 2}}), 0.004) << "interleaved, " << side;
    EXPECT_LT(error({{"averaging", 1}}), 0.002);
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
