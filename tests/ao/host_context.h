// Fixture of the host API: a context on a host's device, with a host's images.
#pragma once

#include "ao/room.h"

namespace obscura::ao {

// All lines that contexts have logged since the test began.
inline std::vector<std::string>& lines() {
    static std::vector<std::string> all;
    return all;
}
inline void keep(void*, Severity, const char* line) { lines().emplace_back(line); }

class ApiTest : public test::GpuTest {
protected:
    gpu::Device& m_device = test::device();
    test::Room m_room;
    gpu::Image m_depth, m_normals;
    gpu::Buffer m_bits;
    Context* m_context = nullptr;

    void SetUp() override {
        test::GpuTest::SetUp();
        lines().clear();
        m_room.wall = -5.0f;
        m_room.build();
        m_depth = m_room.image(m_device, false);
        m_normals = m_room.image(m_device, true);
        const auto bits = std::as_bytes(std::span(m_room.bits));
        ASSERT_EQ(gpu::Buffer::create(m_device, bits.size(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                      gpu::Memory::device, "bits", m_bits),
            gpu::Status::ok);
        ASSERT_EQ(gpu::upload(m_device, m_bits, bits), gpu::Status::ok);
        ASSERT_EQ(create(desc(), &m_context), Status::ok);
    }
    void TearDown() override {
        m_device.waitIdle();
        destroy(m_context);
        m_depth = {};
        m_normals = {};
        m_bits = {};
        test::GpuTest::TearDown();
    }
    DeviceDesc desc() const {
        DeviceDesc d;
        d.instance = m_device.instance();
        d.physicalDevice = m_device.physical();
        d.device = m_device.handle();
        d.queueFamily = m_device.queueFamily();
        d.getInstanceProcAddr = m_device.vk().GetInstanceProcAddr;
        d.log = keep;
        return d;
    }
    Frame frame() const {
        Frame f = m_room.frame();
        f.depth = {m_depth.handle(), m_depth.view(), VK_FORMAT_R32_SFLOAT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        f.normals = {m_normals.handle(), m_normals.view(), VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        f.volume.buffer = m_bits.handle();
        return f;
    }
    Output once(const Frame& f) {
        Output output;
        EXPECT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { output = record(m_context, cmd, f); }), gpu::Status::ok);
        return output;
    }
    std::vector<float> pixels(const Output& output) {
        std::vector<std::byte> bytes;
        EXPECT_EQ(gpu::download(
                      m_device, output.image, {VK_FORMAT_R16_SFLOAT, m_room.visibleWidth(), m_room.visibleHeight()}, output.layout, bytes),
            gpu::Status::ok);
        return test::halvesOf(bytes);
    }
    static bool said(const std::string& part) {
        for (const std::string& line : lines())
            if (line.find(part) != std::string::npos) return true;
        return false;
    }
};

}  // namespace obscura::ao
