// Fixture: runs one shared pass (gather or temporal) on analytic surfaces.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "ao/method.h"
#include "ao/room.h"
#include "ao/view.h"
#include "graph/executor.h"
#include "graph/read_back.h"

namespace obscura::ao {

using Plane = std::vector<float>;
inline constexpr uint32_t kWidth = 40, kHeight = 24, kGuard = 2;
inline constexpr float kHorizontal = 0.05f;  // eye-space metres per px and metre of depth

class PassTest : public test::GpuTest {
protected:
    using Filter = std::function<graph::ImageId(graph::Graph& graph, const Inputs& inputs, graph::ImageId source)>;
    // One frame. Images have the visible size; the guard band repeats their edge.
    struct Frame {
        std::function<float(int x, int y)> visibility = [](int, int) { return 1.0f; };
        std::function<float(int x, int y)> depth = [](int, int) { return 2.0f; };
        std::array<float, 2> motion{0.0f, 0.0f};
        std::array<float, 3> normal{0.0f, 0.0f, 1.0f};
        float advanced = 0.0f, aside = 0.0f;  // metres that the camera moved forward and to the right since last frame
        bool hasMotion = true;
        bool orthographic = false;
        float away = 0.0f;  // metres by which the camera's plane is farther back
    };

    void SetUp() override {
        test::GpuTest::SetUp();
        m_shaders.add(shaders());
    }
    Plane run(const Frame& frame, const Filter& filter) {
        const uint32_t width = kWidth + 2 * kGuard, height = kHeight + 2 * kGuard;
        std::vector<float> depth, motion, visibility;
        std::vector<uint32_t> normals;
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x) {
                depth.push_back(frame.depth(int(x) - int(kGuard), int(y) - int(kGuard)) + frame.away);
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
        inputs.view.skyDepth = 1000.0f + frame.away;
        inputs.view.orthographic = frame.orthographic ? 1.0f : 0.0f;
        inputs.view.pixelsPerMetre = 1.0f / kHorizontal;
        inputs.view.orthographicDepth = orthographicDepth(inputs.view);
        inputs.view.unproject = {kHorizontal, -kHorizontal, -kHorizontal * float(width) / 2, kHorizontal * float(height) / 2};
        inputs.viewBlock = m_graph.upload("view", inputs.view);
        std::vector<gpu::Image> kept(4);
        inputs.depth = image(kept[0], VK_FORMAT_R32_SFLOAT, width, height, depth);
        inputs.normals = image(kept[1], VK_FORMAT_R32_UINT, width, height, normals);
        if (frame.hasMotion) inputs.motion = image(kept[2], VK_FORMAT_R32G32_SFLOAT, width, height, motion);
        inputs.motionScale[0] = inputs.motionScale[1] = 1.0f;
        const shared::vec4& u = inputs.view.unproject;
        inputs.view.project = {1.0f / u.x, 1.0f / u.y, -u.z / u.x, -u.w / u.y};
        inputs.previousView = inputs.view;
        const float rows[12] = {1, 0, 0, frame.aside, 0, 1, 0, 0, 0, 0, 1, -frame.advanced};
        std::copy_n(rows, 12, inputs.previousFromEye);
        std::vector<uint16_t> halves(visibility.size());
        std::transform(visibility.begin(), visibility.end(), halves.begin(), half);
        const graph::ImageId source = image(kept[3], VK_FORMAT_R16_SFLOAT, kWidth, kHeight, halves);

        const graph::ImageId result = filter(m_graph, inputs, source);
        m_passedThrough = result == source;
        if (m_passedThrough) return visibility;
        const gpu::Buffer back = test::readBack(m_graph, result);
        gpu::Status status = gpu::Status::ok;
        EXPECT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { status = m_executor.execute(m_graph, cmd); }), gpu::Status::ok);
        EXPECT_EQ(status, gpu::Status::ok);
        return test::halvesOf(back);
    }

    // Within 0.001 of the float: the precision of visibility in half floats.
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

    template <class T> graph::ImageId image(
        gpu::Image& out, VkFormat format, uint32_t width, uint32_t height, const std::vector<T>& texels) {
        EXPECT_EQ(
            gpu::Image::create(m_device,
                {format, width, height, 1, 1, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
                "pass test", out),
            gpu::Status::ok);
        EXPECT_EQ(gpu::upload(m_device, out, std::as_bytes(std::span(texels)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL), gpu::Status::ok);
        graph::External external{out.handle(), out.view(), out.desc()};
        external.layout = external.layoutAfter = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        return m_graph.import("pass test", external);
    }

    gpu::Device& m_device = test::device();
    gpu::ShaderLibrary m_shaders;
    graph::Graph m_graph{m_device};
    graph::Executor m_executor{m_device};
    bool m_passedThrough = false;
};

// With the pass under test, whose pipelines create() makes.
template <class Tested> class FilterTest : public PassTest {
protected:
    void SetUp() override {
        PassTest::SetUp();
        ASSERT_EQ(Tested::create(m_device, m_shaders, m_filter), Status::ok);
    }
    void TearDown() override {
        m_device.waitIdle();
        m_filter = {};
        PassTest::TearDown();
    }

    Tested m_filter;
};

}  // namespace obscura::ao
