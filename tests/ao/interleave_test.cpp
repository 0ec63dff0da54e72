// Interleaving: the gather pass, and methods whose directions are distributed over a tile against the same methods without interleaving.
#include <bit>

#include "ao/filter_test.h"
#include "ao/interleave.h"
#include "ao/method_test.h"

namespace obscura::ao {
namespace {

class GatherTest : public FilterTest<Gather> {
protected:
    Plane run(const Frame& frame, uint32_t side, bool weighted = false) {
        return PassTest::run(frame, [&](graph::Graph& graph, const Inputs& inputs, graph::ImageId source) {
            if (!weighted) return m_filter.add(graph, inputs, source, side);
            // Every pixel has obscurance 0.25 and some weight: visibility is reduced by a quarter, whatever the weights.
            gpu::Image image;
            std::vector<uint32_t> texels;
            for (uint32_t y = 0; y < kHeight; ++y)
                for (uint32_t x = 0; x < kWidth; ++x) {
                    const float w = 0.5f + 0.125f * float((x + 3 * y) % 5);
                    texels.push_back(half(0.25f * w) | uint32_t(half(w)) << 16);
                }
            return m_filter.add(graph, inputs, this->image(m_input, VK_FORMAT_R16G16_SFLOAT, kWidth, kHeight, texels), side, source);
        });
    }

    // Gathers on a map with one pixel for `scale` x `scale` pixels of a larger image.
    Plane runMap(const Frame& frame, uint32_t scale, uint32_t side) {
        return PassTest::run(frame, [&](graph::Graph& graph, const Inputs& inputs, graph::ImageId source) {
            std::vector<uint32_t> texels;
            for (uint32_t y = 0; y < kHeight; ++y)
                for (uint32_t x = 0; x < kWidth; ++x)
                    texels.insert(texels.end(), {std::bit_cast<uint32_t>(frame.depth(int(x), int(y))), packed(frame.normal)});
            return m_filter.addMap(graph, inputs, source, image(m_input, VK_FORMAT_R32G32_UINT, kWidth, kHeight, texels), scale, side);
        });
    }

    gpu::Image m_input;
};

TEST_F(GatherTest, everyShareIsWeightedOnceAtAnyTileOffset) {
    for (const uint32_t side : {2u, 3u, 4u}) {
        const int n = int(side);
        const Plane plane = run({.visibility = [n](int x, int y) { return float(x % n + n * (y % n)) / 16.0f; }}, side);
        const float mean = 0.5f * float(n * n - 1) / 16.0f;
        for (uint32_t y = 2; y < kHeight - 2; ++y)
            for (uint32_t x = 2; x < kWidth - 2; ++x) ASSERT_NEAR(at(plane, x, y), mean, 0.001f) << side << ": " << x << ", " << y;
    }
}

TEST_F(GatherTest, linearRampIsUnchanged) {  // also for tiles of even side, which have no middle pixel
    for (const uint32_t side : {2u, 3u, 4u}) {
        const Plane plane = run({.visibility = [](int x, int) { return float(x) / 64.0f; }}, side);
        for (uint32_t x = 2; x < kWidth - 2; ++x) ASSERT_NEAR(at(plane, x, 10), float(x) / 64.0f, 0.001f) << side;
    }
}

TEST_F(GatherTest, gatherStopsAtDepthEdges) {
    for (const uint32_t side : {2u, 3u, 4u})
        for (const auto& [orthographic, away] : {std::pair{false, 0.0f}, {true, 0.0f}, {true, 1000.0f}}) {
            const Plane plane = run({.visibility = [](int x, int) { return x < 20 ? 0.0f : 1.0f; },
                                        .depth = [](int x, int) { return x < 20 ? 2.0f : 2.2f; },
                                        .orthographic = orthographic,
                                        .away = away},
                side);
            for (uint32_t x = 0; x < kWidth; ++x) ASSERT_EQ(at(plane, x, 10), x < 20 ? 0.0f : 1.0f) << side << ": " << x << ", " << away;
        }
}

TEST_F(GatherTest, weightsOfSharesAreApplied) {
    for (const uint32_t side : {2u, 3u, 4u}) {
        const Plane plane = run({.visibility = [](int, int) { return 0.75f; }}, side, true);
        for (const float v : plane) ASSERT_NEAR(v, 0.5f, 0.001f) << side;
    }
}

// A plane at 45 degrees, with the depths of pixels as far apart as the map's pixels.
TEST_F(GatherTest, mapPixelsUseTheirOwnPositions) {
    const float scale = 2.0f, slant = 0.70710678f;
    const auto depth = [&](int x, int) {  // z = 4 + eye x, eye x = h z
        const float h = kHorizontal * (float(kGuard) + (float(x) + 0.5f) * scale - 0.5f * float(kWidth + 2 * kGuard));
        return 4.0f / (1.0f - std::min(h, 0.75f));
    };
    const Frame frame{
        .visibility = [](int x, int y) { return float(x % 2 + 2 * (y % 2)) / 4.0f; }, .depth = depth, .normal = {slant, 0.0f, slant}};
    const Plane shared = runMap(frame, 2, 2), misplaced = runMap(frame, 1, 2);
    for (uint32_t y = 1; y < kHeight - 1; ++y)
        for (uint32_t x = 1; x < 12; ++x) {
            ASSERT_NEAR(at(shared, x, y), 0.375f, 0.001f) << x << ", " << y;
            ASSERT_GT(std::fabs(at(misplaced, x, y) - 0.375f), 0.05f) << x << ", " << y;
        }
}

}  // namespace
}  // namespace obscura::ao

namespace obscura::test {
namespace {

class InterleavedMethod : public MethodTest, public testing::WithParamInterface<const char*> {
protected:
    InterleavedMethod() : MethodTest(GetParam()) {}
};

TEST_P(InterleavedMethod, isNearTheUninterleavedResult) {
    Room room;
    room.wall = -5.0f;
    room.build();
    ao::Values settings = values({});
    settings.set("directions", 16);
    settings.set("rays", 64);
    const Picture alone = run(room, settings, "quadratic:2");
    EXPECT_GT(mean(alone), 0.02);
    for (const float tile : {1.0f, 2.0f, 3.0f}) {
        settings.set("interleave", tile);
        const Picture shared = run(room, settings, "quadratic:2");
        EXPECT_TRUE(m_passes.count("interleave.gather"));
        double apart = 0.0;
        for (size_t i = 0; i < alone.size(); ++i) apart += std::fabs(shared[i] - alone[i]);
        const bool map = GetParam() == std::string("hybrid");  // the map is small here, and a share has one or two rays
        EXPECT_NEAR(mean(shared), mean(alone), (map ? 0.12 : 0.07) * mean(alone)) << tile;
        EXPECT_LT(apart / double(alone.size()), map ? 0.02 : 0.008) << tile;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, InterleavedMethod, testing::Values("hbao", "horizon_split", "far_field", "hybrid", "multi_resolution"),
    [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace obscura::test
