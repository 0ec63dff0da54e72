// Interleaving: what the shared gather brings together, and that methods which share out their directions find what they find alone.
#include "ao/method_test.h"
#include "ao/resolve_test.h"

namespace obscura::ao {
namespace {

class GatherTest : public ResolveTest {
protected:
    void SetUp() override {
        ResolveTest::SetUp();
        ASSERT_EQ(Gather::create(m_device, m_shaders, m_gather), Status::ok);
    }
    void TearDown() override {
        m_device.waitIdle();
        m_gather = {};
        ResolveTest::TearDown();
    }
    Plane run(const Frame& frame, uint32_t side, bool weighted = false) {
        return ResolveTest::run(frame, [&](graph::Graph& graph, const Inputs& inputs, graph::ImageId source) {
            if (!weighted) return m_gather.add(graph, inputs, source, side);
            // Of every pixel weight w and obscurance 0.25: whatever the weights, a quarter is taken off what is open.
            gpu::Image image;
            std::vector<uint32_t> parts;
            for (uint32_t y = 0; y < kHeight; ++y)
                for (uint32_t x = 0; x < kWidth; ++x) {
                    const float w = 0.5f + 0.125f * float((x + 3 * y) % 5);
                    parts.push_back(half(0.25f * w) | uint32_t(half(w)) << 16);
                }
            return m_gather.add(graph, inputs, this->image(m_parts, VK_FORMAT_R16G16_SFLOAT, kWidth, kHeight, parts), side, source);
        });
    }

    Gather m_gather;
    gpu::Image m_parts;
};

TEST_F(GatherTest, everyShareCountsOnceWhereverTheTileBegins) {
    for (const uint32_t side : {2u, 3u, 4u}) {
        const int n = int(side);
        const Plane plane = run({.visibility = [n](int x, int y) { return float(x % n + n * (y % n)) / 16.0f; }}, side);
        const float mean = 0.5f * float(n * n - 1) / 16.0f;
        for (uint32_t y = 2; y < kHeight - 2; ++y)
            for (uint32_t x = 2; x < kWidth - 2; ++x) ASSERT_NEAR(at(plane, x, y), mean, 0.001f) << side << ": " << x << ", " << y;
    }
}

TEST_F(GatherTest, staysInPlace) {  // a slope is left alone, also by tiles that have no middle
    for (const uint32_t side : {2u, 3u, 4u}) {
        const Plane plane = run({.visibility = [](int x, int) { return float(x) / 64.0f; }}, side);
        for (uint32_t x = 2; x < kWidth - 2; ++x) ASSERT_NEAR(at(plane, x, 10), float(x) / 64.0f, 0.001f) << side;
    }
}

TEST_F(GatherTest, surfacesShareNothing) {
    for (const uint32_t side : {2u, 3u, 4u}) {
        const Plane plane = run({.visibility = [](int x, int) { return x < 20 ? 0.0f : 1.0f; }, .depth = [](int x, int) { return x < 20 ? 2.0f : 2.2f; }}, side);
        for (uint32_t x = 0; x < kWidth; ++x) ASSERT_EQ(at(plane, x, 10), x < 20 ? 0.0f : 1.0f) << side << ": " << x;
    }
}

TEST_F(GatherTest, weightsAreThoseOfTheParts) {
    for (const uint32_t side : {2u, 3u, 4u}) {
        const Plane plane = run({.visibility = [](int, int) { return 0.75f; }}, side, true);
        for (const float v : plane) ASSERT_NEAR(v, 0.5f, 0.001f) << side;
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

TEST_P(InterleavedMethod, findsWhatItFindsAlone) {
    Room room;
    room.wall = -5.0f;
    room.build();
    const Picture alone = run(room, values({{"directions", 16}}), "quadratic:2");
    EXPECT_GT(mean(alone), 0.02);
    for (const float tile : {1.0f, 2.0f, 3.0f}) {
        const Picture shared = run(room, values({{"directions", 16}, {"interleave", tile}}), "quadratic:2");
        EXPECT_TRUE(m_passes.count("resolve.gather"));
        double apart = 0.0;
        for (size_t i = 0; i < alone.size(); ++i) apart += std::fabs(shared[i] - alone[i]);
        EXPECT_NEAR(mean(shared), mean(alone), 0.06 * mean(alone)) << tile;
        EXPECT_LT(apart / double(alone.size()), 0.008) << tile;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, InterleavedMethod, testing::Values("hbao", "horizon_split", "far_field"), [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace obscura::test
