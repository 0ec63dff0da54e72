// Depth and normals of several samples: the first sample of each pixel is read.
#include "api/host.h"

namespace obscura::ao {
namespace {

class Multisample : public test::GpuTest {
protected:
    gpu::Device& m_device = test::device();
    test::Host m_host{m_device};
    struct Target {
        VkImage image = VK_NULL_HANDLE;
        VkDeviceMemory memory = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
        VkFormat format = VK_FORMAT_UNDEFINED;
    };
    std::vector<Target> m_targets;

    void TearDown() override {
        m_host.clear();
        const gpu::Api& vk = m_device.vk();
        for (const Target& target : m_targets) {
            vk.DestroyImageView(m_device.handle(), target.view, nullptr);
            vk.DestroyImage(m_device.handle(), target.image, nullptr);
            vk.FreeMemory(m_device.handle(), target.memory, nullptr);
        }
        GpuTest::TearDown();
    }
    // An image of four samples as an engine's G-buffer has it.
    Target make(VkFormat format, VkExtent2D size) {
        const gpu::Api& vk = m_device.vk();
        const bool depth = gpu::aspectOf(format) & VK_IMAGE_ASPECT_DEPTH_BIT;
        VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = format;
        info.extent = {size.width, size.height, 1};
        info.mipLevels = info.arrayLayers = 1;
        info.samples = VK_SAMPLE_COUNT_4_BIT;
        info.usage =
            VK_IMAGE_USAGE_SAMPLED_BIT | (depth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        Target made;
        made.format = format;
        EXPECT_EQ(vk.CreateImage(m_device.handle(), &info, nullptr, &made.image), VK_SUCCESS);
        VkMemoryRequirements needs;
        vk.GetImageMemoryRequirements(m_device.handle(), made.image, &needs);
        uint32_t type = 0;
        while (!(needs.memoryTypeBits >> type & 1u)) ++type;
        const VkMemoryAllocateInfo memory{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size, type};
        EXPECT_EQ(vk.AllocateMemory(m_device.handle(), &memory, nullptr, &made.memory), VK_SUCCESS);
        EXPECT_EQ(vk.BindImageMemory(m_device.handle(), made.image, made.memory, 0), VK_SUCCESS);
        const VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, nullptr, 0, made.image, VK_IMAGE_VIEW_TYPE_2D, format,
            {}, {VkImageAspectFlags(depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT), 0, 1, 0, 1}};
        EXPECT_EQ(vk.CreateImageView(m_device.handle(), &view, nullptr, &made.view), VK_SUCCESS);
        m_targets.push_back(made);
        return made;
    }
    // Draws the picture, a rectangle a pixel, and leaves both targets as attachments.
    void draw(const Target& depth, const Target& normals, VkExtent2D size, const std::vector<float>& z, const std::vector<float>& n) {
        const gpu::Api& vk = m_device.vk();
        const auto clear = reinterpret_cast<PFN_vkCmdClearAttachments>(vk.GetDeviceProcAddr(m_device.handle(), "vkCmdClearAttachments"));
        ASSERT_NE(clear, nullptr);
        EXPECT_EQ(m_device.runNow([&](VkCommandBuffer cmd) {
            m_host.change(cmd, depth.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
            m_host.change(
                cmd, normals.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
            VkRenderingAttachmentInfo depthTarget{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO}, normalTarget = depthTarget;
            depthTarget.imageView = depth.view;
            depthTarget.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
            depthTarget.loadOp = normalTarget.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
            depthTarget.storeOp = normalTarget.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
            normalTarget.imageView = normals.view;
            normalTarget.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
            VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
            rendering.renderArea = {{}, size};
            rendering.layerCount = 1;
            rendering.colorAttachmentCount = 1;
            rendering.pColorAttachments = &normalTarget;
            rendering.pDepthAttachment = &depthTarget;
            vk.CmdBeginRendering(cmd, &rendering);
            for (uint32_t i = 0; i < size.width * size.height; ++i) {
                VkClearAttachment values[2] = {};
                values[0].aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
                values[0].clearValue.depthStencil.depth = z[i];
                values[1].aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
                for (size_t c = 0; c < 4; ++c) values[1].clearValue.color.float32[c] = n[4 * i + c];
                const VkClearRect pixel{{{int32_t(i % size.width), int32_t(i / size.width)}, {1, 1}}, 0, 1};
                clear(cmd, 2, values, 1, &pixel);
            }
            vk.CmdEndRendering(cmd);
        }),
            gpu::Status::ok);
    }
};

TEST_F(Multisample, isReadAsOneSample) {
    test::Geometry g;
    g.visible = {40, 24};
    g.guard = {4, 4};
    const test::Picture picture = test::trace(g);
    test::Shot shot{g, {test::Depth::reversed, VK_FORMAT_D32_SFLOAT}, {}};
    Frame frame = m_host.frame(shot, picture);
    ASSERT_EQ(create(m_host.desc(), &m_host.context), Status::ok) << m_host.allSaid();
    ASSERT_EQ(setMethod(m_host.context, "hbao", {}), Status::ok);
    const std::vector<float> expected = m_host.pixels(m_host.record(frame), g.visible);

    const std::vector<std::byte> coded = test::encodeDepth(g, shot.depth, picture), facing = test::encodeNormals(g, shot.normals, picture);
    std::vector<float> z(coded.size() / 4), n(facing.size() / 4);
    std::memcpy(z.data(), coded.data(), coded.size());
    std::memcpy(n.data(), facing.data(), facing.size());
    const Target depth = make(VK_FORMAT_D32_SFLOAT, frame.size), normals = make(VK_FORMAT_R32G32B32A32_SFLOAT, frame.size);
    draw(depth, normals, frame.size, z, n);
    frame.depth = {depth.image, depth.view, depth.format, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
    frame.normals = {normals.image, normals.view, normals.format, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    frame.depth.samples = frame.normals.samples = VK_SAMPLE_COUNT_4_BIT;
    const Output output = m_host.record(frame);
    ASSERT_EQ(output.status, Status::ok) << m_host.allSaid();
    EXPECT_EQ(m_host.pixels(output, g.visible), expected);
}

}  // namespace
}  // namespace obscura::ao
