// The shared temporal pass on an analytic wall: averaging, reprojection, disocclusion, history clamping.
#include <random>
#include <utility>

#include "ao/filter_test.h"

namespace obscura::ao {
namespace {

class TemporalTest : public FilterTest<Temporal> {
protected:
    Plane run(const Frame& frame, const TemporalSettings& settings) {
        return PassTest::run(frame, [&](graph::Graph& graph, const Inputs& inputs, graph::ImageId source) {
            return m_filter.add(graph, inputs, source, settings, m_history, std::exchange(m_discard, false), "temporal");
        });
    }

    void TearDown() override {
        m_device.waitIdle();
        m_history = {};
        FilterTest::TearDown();
    }

    graph::History m_history;
    bool m_discard = false;  // history, in the next frame
};

TemporalSettings papers(float k) { return {.history = k, .clip = 0.0f}; }
std::function<float(int, int)> flat(float v) {
    return [v](int, int) { return v; };
}

TEST_F(TemporalTest, historyOfOneHalfHalvesTheDifferenceEachFrame) {
    run({.visibility = flat(1.0f)}, papers(0.5f));
    float expected = 1.0f;
    for (int i = 0; i < 5; ++i) {
        expected *= 0.5f;
        for (const float v : run({.visibility = flat(0.0f)}, papers(0.5f))) ASSERT_NEAR(v, expected, 5e-4f);
    }
}

TEST_F(TemporalTest, averagesEvenlyUntilItsFullLength) {
    for (const float v : run({.visibility = flat(0.9f)}, papers(0.9f))) ASSERT_NEAR(v, 0.9f, 1e-3f);  // no history yet
    for (const float v : run({.visibility = flat(0.3f)}, papers(0.9f))) ASSERT_NEAR(v, 0.6f, 1e-3f);
    for (const float v : run({.visibility = flat(0.0f)}, papers(0.9f))) ASSERT_NEAR(v, 0.4f, 1e-3f);
}

TEST_F(TemporalTest, removesNoiseAndKeepsTheMean) {
    std::mt19937 random(7);
    std::normal_distribution<float> noise(0.6f, 0.05f);
    Plane last;
    for (int i = 0; i < 40; ++i) last = run({.visibility = [&](int, int) { return noise(random); }}, {.history = 0.95f, .clip = 2.0f});
    double sum = 0.0, square = 0.0;
    for (const float v : last) sum += v, square += double(v) * v;
    const double mean = sum / double(last.size()), deviation = std::sqrt(square / double(last.size()) - mean * mean);
    EXPECT_NEAR(mean, 0.6, 0.004);
    EXPECT_LT(deviation, 0.05 / 3.0);
}

// A gradient of visibility must not widen the clamp: history from before it moved is clamped.
TEST_F(TemporalTest, gradientDoesNotWidenTheClamp) {
    const auto shadow = [](float from) { return [=](int x, int) { return from + float(x) / 64.0f; }; };
    for (int i = 0; i < 10; ++i) run({.visibility = shadow(0.3f)}, {});
    const Plane last = run({.visibility = shadow(0.1f)}, {});
    for (uint32_t x = 3; x < kWidth - 3; ++x) ASSERT_NEAR(at(last, x, 12), 0.1f + float(x) / 64.0f, 0.012f) << x;
}

// Uniform noise over time has no spread in space, so the clamp also uses each pixel's deviation over time: for moving pixels all of it, for
// resting pixels only changes that alternate in sign.
TEST_F(TemporalTest, deviationOverTimeWidensTheClamp) {
    const auto swing = [&](float pixelsPerFrame, int from, int end) {
        m_discard = true;
        float most = 0.0f;
        for (int i = 0; i < end; ++i) {
            const Plane plane = run({.visibility = flat(i % 2 ? 0.65f : 0.55f), .motion = {pixelsPerFrame, 0.0f}}, {});
            if (i >= from) most = std::max(most, std::fabs(at(plane, kWidth / 4, 12) - 0.6f));
        }
        return most;
    };
    EXPECT_LT(swing(0.5f, 10, 14), 0.015f);
    EXPECT_LT(swing(0.0f, 30, 40), 0.015f);
}

// A shadow that grew slowly vanishes as fast as any other: changes of one sign do not widen the clamp of a resting pixel.
TEST_F(TemporalTest, changesOfOneSignDoNotWidenTheClamp) {
    for (int i = 0; i < 20; ++i) run({.visibility = flat(0.9f - 0.03f * float(i))}, {});
    Plane last;
    for (int i = 0; i < 3; ++i) last = run({.visibility = flat(0.9f)}, {});
    for (const float v : last) ASSERT_NEAR(v, 0.9f, 0.06f);
}

// A single change is not noise: after steady frames a shadow vanishes together with its occluder, with the camera moving or at rest.
TEST_F(TemporalTest, shadowVanishesWithItsOccluder) {
    for (const float speed : {0.5f, 0.0f}) {
        m_discard = true;
        for (int i = 0; i < 20; ++i) run({.visibility = flat(0.3f), .motion = {speed, 0.0f}}, {});
        run({.visibility = flat(0.9f), .motion = {speed, 0.0f}}, {});
        Plane last;
        for (int i = 0; i < 2; ++i) last = run({.visibility = flat(0.9f), .motion = {speed, 0.0f}}, {});
        for (uint32_t x = 0; x < kWidth - 4; ++x) ASSERT_NEAR(at(last, x, 12), 0.9f, 0.06f) << x << ", " << speed << " px a frame";
    }
}

// A slow running average in 16-bit floats would stop before it reaches its input.
TEST_F(TemporalTest, convergesToItsInput) {
    run({.visibility = flat(0.5f)}, papers(0.97f));
    Plane last;
    for (int i = 0; i < 200; ++i) last = run({.visibility = flat(0.75f)}, papers(0.97f));
    for (const float v : last) ASSERT_NEAR(v, 0.75f, 0.002f);
}

TEST_F(TemporalTest, reprojectsBySubpixelMotion) {
    // A ramp that moves right by 1.5 px a frame: its history is 1.5 px to the left.
    const auto ramp = [](int frame) { return [=](int x, int) { return 0.2f + 0.01f * (float(x) - 1.5f * float(frame)); }; };
    Plane last;
    for (int i = 0; i < 6; ++i) last = run({.visibility = ramp(i), .motion = {-1.5f, 0.0f}}, papers(0.9f));
    for (uint32_t x = 10; x < kWidth; ++x) ASSERT_NEAR(at(last, x, 12), ramp(5)(int(x), 12), 1.5e-3f) << x;
    for (int i = 0; i < 6; ++i) last = run({.visibility = ramp(i)}, papers(0.9f));  // with motion of zero, it lags
    EXPECT_GT(std::fabs(at(last, 20, 12) - ramp(5)(20, 12)), 0.015f);
}

TEST_F(TemporalTest, discardsHistoryAtDisocclusions) {
    const auto wall = [](int edge) { return [=](int x, int) { return x < edge ? 1.0f : 2.0f; }; };
    // The camera plane of an orthographic view is arbitrary.
    struct Case {
        bool orthographic;
        float away;
        bool hasMotion;
    };
    for (const auto& [orthographic, away, hasMotion] : {Case{false, 0.0f, true}, {true, 0.0f, true}, {true, 1000.0f, true},
             {false, 0.0f, false}, {true, 0.0f, false}, {true, 1000.0f, false}}) {
        m_discard = true;
        const auto frame = [&](float visibility, int edge) {
            return Frame{
                .visibility = flat(visibility), .depth = wall(edge), .hasMotion = hasMotion, .orthographic = orthographic, .away = away};
        };
        for (int i = 0; i < 4; ++i) run(frame(0.2f, 20), papers(0.9f));
        const Plane last = run(frame(0.8f, 10), papers(0.9f));
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) {  // 10..19: the far wall is disoccluded
                if (x >= 10 && x < 20) ASSERT_NEAR(at(last, x, y), 0.8f, 1e-3f) << x << ", " << away;
                else ASSERT_LT(at(last, x, y), 0.4f) << x << ", " << away;
            }
    }
}

TEST_F(TemporalTest, discardsHistoryWhereTheNormalChanges) {
    run({.visibility = flat(0.2f)}, papers(0.9f));
    for (const float v : run({.visibility = flat(0.8f), .normal = {0.8f, 0.0f, 0.6f}}, papers(0.9f))) ASSERT_NEAR(v, 0.8f, 1e-3f);
}

TEST_F(TemporalTest, discardsHistoryOutsideTheImage) {
    run({.visibility = flat(0.2f)}, papers(0.9f));
    const Plane last = run({.visibility = flat(0.8f), .motion = {5.0f, 0.0f}}, papers(0.9f));
    EXPECT_NEAR(at(last, kWidth - 3, 5), 0.8f, 1e-3f);
    EXPECT_NEAR(at(last, kWidth - 8, 5), 0.5f, 1e-3f);
}

// A camera that moves towards a wall sees the same surface at smaller depths; the camera's motion keeps its history valid.
TEST_F(TemporalTest, keepsHistoryWhenTheCameraMovesForward) {
    const auto afterMoving = [&](float metres, bool hasMotion) {
        m_discard = true;
        run({.visibility = flat(0.2f)}, papers(0.9f));
        const Frame frame{.visibility = flat(0.8f), .depth = flat(1.8f), .advanced = metres, .hasMotion = hasMotion};
        return at(run(frame, papers(0.9f)), kWidth / 2, kHeight / 2);
    };
    EXPECT_NEAR(afterMoving(0.2f, true), 0.5f, 1e-3f);
    EXPECT_NEAR(afterMoving(0.0f, true), 0.8f, 1e-3f);
    EXPECT_NEAR(afterMoving(0.2f, false), 0.5f, 1e-3f);
    EXPECT_NEAR(afterMoving(0.0f, false), 0.8f, 1e-3f);
}

// Without motion images an object that moves by itself, here to the right by 2 px a frame, takes no history from the wall behind it and
// leaves none on the wall.
TEST_F(TemporalTest, withoutMotionAMovedObjectLeavesNoTrail) {
    for (const bool orthographic : {false, true}) {
        m_discard = true;
        const auto covers = [](int i, int x) { return x >= 2 * i && x < 2 * i + 8; };
        for (int i = 0; i < 14; ++i) {
            const Plane plane = run({.visibility = [=](int x, int) { return covers(i, x) ? 0.9f : 0.4f; },
                                        .depth = [=](int x, int) { return covers(i, x) ? 1.0f : 2.0f; },
                                        .hasMotion = false,
                                        .orthographic = orthographic},
                {});
            for (int x = 0; x < int(kWidth); ++x)
                ASSERT_NEAR(at(plane, uint32_t(x), 12), covers(i, x) ? 0.9f : 0.4f, 0.012f) << i << " " << x;
        }
    }
}

// A camera that moves to the right by 0.1 m sees the wall, 2 m away, 1 px to the left.
TEST_F(TemporalTest, withoutMotionHistoryFollowsTheCamera) {
    const auto ramp = [](int frame) { return [=](int x, int) { return 0.2f + 0.01f * (float(x) + 1.5f * float(frame)); }; };
    Plane last;
    for (int i = 0; i < 6; ++i) last = run({.visibility = ramp(i), .aside = 0.15f, .hasMotion = false}, papers(0.9f));
    for (uint32_t x = 0; x < kWidth - 12; ++x) ASSERT_NEAR(at(last, x, 12), ramp(5)(int(x), 12), 1.5e-3f) << x;
}

// The floor rests, the occluder above it moves.
TEST_F(TemporalTest, discardsTheShadowOfAMovedOccluder) {
    const auto foot = [](int x, int y) { return x >= 10 && x < 30 && y >= 6 && y < 18 ? 0.3f : 1.0f; };
    const auto framesToClear = [&](const TemporalSettings& settings, bool hasMotion = true) {
        m_discard = true;
        for (int i = 0; i < 20; ++i) run({.visibility = foot, .hasMotion = hasMotion}, settings);
        for (int i = 1; i < 60; ++i) {
            float worst = 0.0f;
            for (const float v : run({.hasMotion = hasMotion}, settings)) worst = std::max(worst, 1.0f - v);
            if (worst <= 0.07f) return i;
        }
        return 60;
    };
    EXPECT_LE(framesToClear({}), 2);
    EXPECT_LE(framesToClear({}, false), 2);
    EXPECT_GT(framesToClear(papers(0.9f)), 15);
}

TEST_F(TemporalTest, resetDiscardsAllHistory) {
    for (int i = 0; i < 4; ++i) run({.visibility = flat(0.2f)}, papers(0.9f));
    m_discard = true;
    for (const float v : run({.visibility = flat(0.8f)}, papers(0.9f))) ASSERT_NEAR(v, 0.8f, 1e-3f);
}

TEST_F(TemporalTest, withoutHistoryNoPassIsAdded) {
    for (const bool hasMotion : {true, false}) {
        run({.hasMotion = hasMotion}, {.history = 0.0f});
        EXPECT_TRUE(m_passedThrough);
        run({.hasMotion = hasMotion}, {});
        EXPECT_FALSE(m_passedThrough);
    }
}

TEST_F(TemporalTest, skyIsUnchanged) {
    run({.visibility = flat(0.2f), .depth = flat(5000.0f)}, papers(0.9f));
    for (const float v : run({.visibility = flat(1.0f), .depth = flat(5000.0f)}, papers(0.9f))) ASSERT_EQ(v, 1.0f);
    // Sky is not accepted as history of a surface in front of it.
    for (const float v : run({.visibility = flat(0.5f)}, papers(0.9f))) ASSERT_NEAR(v, 0.5f, 1e-3f);
}

}  // namespace
}  // namespace obscura::ao
