// The shared temporal pass on a wall made by hand: what it averages, follows, forgets and refuses.
#include <cmath>
#include <functional>
#include <random>

#include "ao/resolve.h"
#include "ao/room.h"

namespace obscura::ao {
namespace {

using Plane = std::vector<float>;
constexpr uint32_t kWidth = 40, kHeight = 24, kGuard = 2;
constexpr float kHorizontal = 0.05f;  // eye metres a pixel, per metre of depth

class TemporalTest : public test::GpuTest {
protected:
    // One frame; images are of the visible part, the guard band repeats the edge.
    struct Frame {
        std::function<float(int x, int y)> visibility = [](int, int) { return 1.0f; };
        std::function<float(int x, int y)> depth = [](int, int) { return 2.0f; };
        std::array<float, 2> motion{0.0f, 0.0f};
        std::array<float, 3> normal{0.0f, 0.0f, 1.0f};
        float advanced = 0.0f;  // metres the camera went forward since last frame
        bool hasMotion = true;
    };

    void SetUp() override {
        test::GpuTest::SetUp();
        m_shaders.add(shaders());
        ASSERT_EQ(Temporal::create(m_device, m_shaders, m_temporal), Status::ok);
    }
    void TearDown() override {
        m_device.waitIdle();
        m_temporal = {};
        test::GpuTest::TearDown();
    }

    Plane run(const Frame& frame, const TemporalSettings& settings) {
        const uint32_t width = kWidth + 2 * kGuard, height = kHeight + 2 * kGuard;
        std::vector<float> depth, motion, visibility;
        std::vector<uint32_t> normals;
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x) {
                depth.push_back(frame.depth(int(x) - int(kGuard), int(y) - int(kGuard)));
                normals.push_back(packed(frame.normal));
                motion.insert(motion.end(), {frame.motion[0], frame.motion[1]});
            }
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) visibility.push_back(frame.visibility(int(x), int(y)));

        m_device.nextFrame();
        m_graph.begin();
        Inputs inputs{};
        inputs.view.size = {width, height};
        inputs.view.visible = {kWidth, kHeight};
        inputs.view.guard = {kGuard, kGuard};
        inputs.view.skyDepth = 1000.0f;
        inputs.view.unproject = {kHorizontal, -kHorizontal, -kHorizontal * float(width) / 2, kHorizontal * float(height) / 2};
        inputs.viewBlock = m_graph.upload("view", inputs.view);
        std::vector<gpu::Image> kept(4);
        inputs.depth = image(kept[0], VK_FORMAT_R32_SFLOAT, width, height, depth);
        inputs.normals = image(kept[1], VK_FORMAT_R32_UINT, width, height, normals);
        if (frame.hasMotion) inputs.motion = image(kept[2], VK_FORMAT_R32G32_SFLOAT, width, height, motion);
        inputs.motionScale[0] = inputs.motionScale[1] = 1.0f;
        const float rows[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -frame.advanced};
        std::copy_n(rows, 12, inputs.previousFromEye);
        std::vector<uint16_t> halves;
        for (const float v : visibility) halves.push_back(half(v));
        const graph::ImageId source = image(kept[3], VK_FORMAT_R16_SFLOAT, kWidth, kHeight, halves);

        const graph::ImageId result = m_temporal.add(m_graph, inputs, source, settings, "temporal");
        m_passedThrough = result == source;
        if (m_passedThrough) return visibility;
        gpu::Buffer back;
        EXPECT_EQ(gpu::Buffer::create(m_device, kWidth * kHeight * 2, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback, "back", back), gpu::Status::ok);
        const graph::BufferId target = m_graph.import("back", back, graph::Graph::Shared::written);
        m_graph.pass("read back").use(result, graph::Access::transferRead).use(target, graph::Access::transferWrite)
            .record([&, result](const graph::PassContext& c) {
                const VkBufferImageCopy region{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, {kWidth, kHeight, 1}};
                c.device.vk().CmdCopyImageToBuffer(c.cmd, c.image(result), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, back.handle(), 1, &region);
            });
        gpu::Status status = gpu::Status::ok;
        EXPECT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { status = m_graph.execute(cmd); }), gpu::Status::ok);
        EXPECT_EQ(status, gpu::Status::ok);
        std::vector<uint16_t> words(kWidth * kHeight);
        std::memcpy(words.data(), back.mapped(), words.size() * 2);
        Plane plane;
        for (const uint16_t h : words) plane.push_back(test::halfToFloat(h));
        return plane;
    }

    // Never more than a thousandth from the float, which is what a half keeps of visibility.
    static uint16_t half(float v) {
        if (v <= 0.0f) return 0;
        int exponent = 0;
        const float mantissa = std::frexp(v, &exponent);
        return uint16_t(((exponent + 14) << 10) + int(std::lround((mantissa * 2.0f - 1.0f) * 1024.0f)));
    }
    static uint32_t packed(const std::array<float, 3>& n) {  // packNormal(), z > 0
        const float sum = std::fabs(n[0]) + std::fabs(n[1]) + std::fabs(n[2]);
        const auto word = [&](float v) { return uint32_t(uint16_t(int16_t(std::lround(v / sum * 32767.0f)))); };
        return word(n[0]) | word(n[1]) << 16;
    }
    static float at(const Plane& plane, uint32_t x, uint32_t y) { return plane[y * kWidth + x]; }

    template <class T> graph::ImageId image(gpu::Image& out, VkFormat format, uint32_t width, uint32_t height, const std::vector<T>& texels) {
        EXPECT_EQ(gpu::Image::create(m_device, {format, width, height, 1, 1, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
                                     "temporal test", out), gpu::Status::ok);
        EXPECT_EQ(gpu::upload(m_device, out, std::as_bytes(std::span(texels)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL), gpu::Status::ok);
        graph::External external{out.handle(), out.view(), out.desc()};
        external.layout = external.layoutAfter = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        return m_graph.import("temporal test", external);
    }

    gpu::Device& m_device = test::device();
    gpu::ShaderLibrary m_shaders;
    graph::Graph m_graph{m_device};
    Temporal m_temporal;
    bool m_passedThrough = false;
};

TemporalSettings papers(float k) { return {.history = k, .clip = 0.0f}; }
std::function<float(int, int)> flat(float v) {
    return [v](int, int) { return v; };
}

TEST_F(TemporalTest, halvesEachFrameWithAHistoryOfOneHalf) {
    run({.visibility = flat(1.0f)}, papers(0.5f));
    float expected = 1.0f;
    for (int i = 0; i < 5; ++i) {
        expected *= 0.5f;
        for (const float v : run({.visibility = flat(0.0f)}, papers(0.5f))) ASSERT_NEAR(v, expected, 5e-4f);
    }
}

TEST_F(TemporalTest, averagesEvenlyUntilItsLengthIsReached) {
    for (const float v : run({.visibility = flat(0.9f)}, papers(0.9f))) ASSERT_NEAR(v, 0.9f, 1e-3f);  // nothing before
    for (const float v : run({.visibility = flat(0.3f)}, papers(0.9f))) ASSERT_NEAR(v, 0.6f, 1e-3f);
    for (const float v : run({.visibility = flat(0.0f)}, papers(0.9f))) ASSERT_NEAR(v, 0.4f, 1e-3f);
}

TEST_F(TemporalTest, takesNoiseAndLeavesTheMean) {
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

// A slow average of 16-bit floats would stand still away from its goal.
TEST_F(TemporalTest, reachesTheValueItIsFed) {
    run({.visibility = flat(0.5f)}, papers(0.97f));
    Plane last;
    for (int i = 0; i < 200; ++i) last = run({.visibility = flat(0.75f)}, papers(0.97f));
    for (const float v : last) ASSERT_NEAR(v, 0.75f, 0.002f);
}

TEST_F(TemporalTest, followsMotionBetweenPixels) {
    // A ramp that goes right by 1.5 pixels a frame: the past is 1.5 to the left.
    const auto ramp = [](int frame) { return [=](int x, int) { return 0.2f + 0.01f * (float(x) - 1.5f * float(frame)); }; };
    Plane last;
    for (int i = 0; i < 6; ++i) last = run({.visibility = ramp(i), .motion = {-1.5f, 0.0f}}, papers(0.9f));
    for (uint32_t x = 10; x < kWidth; ++x) ASSERT_NEAR(at(last, x, 12), ramp(5)(int(x), 12), 1.5e-3f) << x;
    for (int i = 0; i < 6; ++i) last = run({.visibility = ramp(i)}, papers(0.9f));  // told that nothing moves, it lags
    EXPECT_GT(std::fabs(at(last, 20, 12) - ramp(5)(20, 12)), 0.015f);
}

TEST_F(TemporalTest, startsAnewOnWhatWasHidden) {
    const auto wall = [](int edge) { return [=](int x, int) { return x < edge ? 1.0f : 2.0f; }; };
    for (int i = 0; i < 4; ++i) run({.visibility = flat(0.2f), .depth = wall(20)}, papers(0.9f));
    const Plane last = run({.visibility = flat(0.8f), .depth = wall(10)}, papers(0.9f));  // 10..19: the far wall comes out
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            if (x >= 10 && x < 20) ASSERT_NEAR(at(last, x, y), 0.8f, 1e-3f) << x;
            else ASSERT_LT(at(last, x, y), 0.4f) << x;
        }
}

TEST_F(TemporalTest, startsAnewWhereTheSurfaceTurned) {
    run({.visibility = flat(0.2f)}, papers(0.9f));
    for (const float v : run({.visibility = flat(0.8f), .normal = {0.8f, 0.0f, 0.6f}}, papers(0.9f))) ASSERT_NEAR(v, 0.8f, 1e-3f);
}

TEST_F(TemporalTest, startsAnewWhereThePastLiesOutsideThePicture) {
    run({.visibility = flat(0.2f)}, papers(0.9f));
    const Plane last = run({.visibility = flat(0.8f), .motion = {5.0f, 0.0f}}, papers(0.9f));
    EXPECT_NEAR(at(last, kWidth - 3, 5), 0.8f, 1e-3f);
    EXPECT_NEAR(at(last, kWidth - 8, 5), 0.5f, 1e-3f);
}

// A camera that goes towards a wall sees other depths of the same surface; told where it came from it keeps the past.
TEST_F(TemporalTest, knowsTheCameraCameNearer) {
    const auto go = [&](float told) {
        m_temporal.reset();
        run({.visibility = flat(0.2f)}, papers(0.9f));
        return at(run({.visibility = flat(0.8f), .depth = flat(1.8f), .advanced = told}, papers(0.9f)), kWidth / 2, kHeight / 2);
    };
    EXPECT_NEAR(go(0.2f), 0.5f, 1e-3f);
    EXPECT_NEAR(go(0.0f), 0.8f, 1e-3f);
}

// The floor did not move, the foot above it did.
TEST_F(TemporalTest, forgetsTheShadowOfWhatWentAway) {
    const auto foot = [](int x, int y) { return x >= 10 && x < 30 && y >= 6 && y < 18 ? 0.3f : 1.0f; };
    const auto framesToClear = [&](const TemporalSettings& settings) {
        m_temporal.reset();
        for (int i = 0; i < 20; ++i) run({.visibility = foot}, settings);
        for (int i = 1; i < 60; ++i) {
            float worst = 0.0f;
            for (const float v : run({}, settings)) worst = std::max(worst, 1.0f - v);
            if (worst <= 0.07f) return i;
        }
        return 60;
    };
    EXPECT_LE(framesToClear({}), 2);
    EXPECT_GT(framesToClear(papers(0.9f)), 15);
}

TEST_F(TemporalTest, aResetForgetsEverything) {
    for (int i = 0; i < 4; ++i) run({.visibility = flat(0.2f)}, papers(0.9f));
    m_temporal.reset();
    for (const float v : run({.visibility = flat(0.8f)}, papers(0.9f))) ASSERT_NEAR(v, 0.8f, 1e-3f);
}

TEST_F(TemporalTest, withoutMotionOrHistoryNothingIsAdded) {
    run({.hasMotion = false}, {});
    EXPECT_TRUE(m_passedThrough);
    run({}, {.history = 0.0f});
    EXPECT_TRUE(m_passedThrough);
    run({}, {});
    EXPECT_FALSE(m_passedThrough);
}

TEST_F(TemporalTest, theSkyStaysAsItCame) {
    run({.visibility = flat(0.2f), .depth = flat(5000.0f)}, papers(0.9f));
    for (const float v : run({.visibility = flat(1.0f), .depth = flat(5000.0f)}, papers(0.9f))) ASSERT_EQ(v, 1.0f);
    // And is no past of what comes before it.
    for (const float v : run({.visibility = flat(0.5f)}, papers(0.9f))) ASSERT_NEAR(v, 0.5f, 1e-3f);
}

}  // namespace
}  // namespace obscura::ao
