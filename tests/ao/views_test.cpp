// Parts, mips and layers of a host's images, and both conventions of jitter.
#include <cmath>

#include "ao/host_context.h"

namespace obscura::ao {
namespace {

// Texels of `channels` floats, placed at `at` in a larger image; the rest is `around`.
std::vector<float> embedded(
    const std::vector<float>& texels, VkExtent2D size, uint32_t channels, VkExtent2D whole, VkOffset2D at, float around) {
    std::vector<float> all(size_t(whole.width) * whole.height * channels, around);
    for (uint32_t y = 0; y < size.height; ++y)
        for (uint32_t i = 0; i < size.width * channels; ++i)
            all[(size_t(y + uint32_t(at.y)) * whole.width + uint32_t(at.x)) * channels + i] = texels[size_t(y) * size.width * channels + i];
    return all;
}

// All images of a frame: as they are, or as parts of larger ones whose other texels are a wall in front of the eye.
class ViewsTest : public ApiTest {
protected:
    static constexpr VkOffset2D kOrigin{24, 10};

    struct Images {
        gpu::Image depth, normals, motion, thickness, second;
    };
    Images images(bool parts) {
        m_room.thickness.assign(m_room.depth.size(), 0.5f);
        m_room.second.clear();
        for (size_t i = 0; i < size_t(half().width) * half().height; ++i) m_room.second.insert(m_room.second.end(), {6.0f, 0.2f});
        std::vector<float> motion;
        for (size_t i = 0; i < m_room.depth.size(); ++i) motion.insert(motion.end(), {1.5f, -0.5f});
        const auto made = [&](VkFormat format, const std::vector<float>& texels, VkExtent2D size, uint32_t channels, int32_t side) {
            if (!parts) return test::Room::uploaded(m_device, format, size, texels, "whole");
            const VkExtent2D whole{size.width + 60, size.height + 30};
            return test::Room::uploaded(
                m_device, format, whole, embedded(texels, size, channels, whole, {kOrigin.x / side, kOrigin.y / side}, 0.3f), "part");
        };
        return {made(VK_FORMAT_R32_SFLOAT, m_room.depth, full(), 1, 1), made(VK_FORMAT_R32G32B32A32_SFLOAT, m_room.normals, full(), 4, 1),
            made(VK_FORMAT_R32G32_SFLOAT, motion, full(), 2, 1), made(VK_FORMAT_R32_SFLOAT, m_room.thickness, full(), 1, 1),
            made(VK_FORMAT_R32G32_SFLOAT, m_room.second, half(), 2, 2)};
    }
    VkExtent2D full() const { return {m_room.width, m_room.height}; }
    VkExtent2D half() const { return {(m_room.width + 1) / 2, (m_room.height + 1) / 2}; }
    Frame frameOf(const Images& i, VkOffset2D origin) const {
        const auto view = [](const gpu::Image& image) {
            return ImageView{image.handle(), image.view(), image.desc().format, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        };
        Frame f = m_room.frame();
        f.origin = origin;
        f.depth = view(i.depth);
        f.normals = view(i.normals);
        f.motion = view(i.motion);
        f.layers = {view(i.thickness), view(i.second), half()};
        f.volume.buffer = m_bits.handle();
        return f;
    }
    // The second of two frames, with history.
    std::vector<float> second(Frame f) {
        f.cut = true;
        EXPECT_EQ(once(f).status, Result::ok);
        f.cut = false;
        f.index = 1;
        return pixels(once(f));
    }
};

TEST_F(ViewsTest, partsOfLargerImagesGiveTheSamePicture) {
    const Images whole = images(false), parts = images(true);
    const Setting settings[] = {{"temporal", 0.9f}, {"depth_layers", 2.0f}};
    for (const MethodInfo* info : methods()) {
        MethodSettings all;
        all.settings = {settings, 2};
        for (; all.settings.count > 0 && setMethod(m_context, info->id, all) != Result::ok;) --all.settings.count;
        ASSERT_EQ(setMethod(m_context, info->id, all), Result::ok) << info->id;
        EXPECT_EQ(second(frameOf(parts, kOrigin)), second(frameOf(whole, {}))) << info->id;
        // The upper left part without an origin, as ever.
        Frame f = m_room.frame();
        f.depth = frameOf(whole, {}).depth;
        Frame larger = f;
        const auto padded = embedded(m_room.depth, full(), 1, {m_room.width + 40, m_room.height + 9}, {}, 0.3f);
        const gpu::Image image =
            test::Room::uploaded(m_device, VK_FORMAT_R32_SFLOAT, {m_room.width + 40, m_room.height + 9}, padded, "upper left");
        larger.depth.image = image.handle();
        larger.depth.view = image.view();
        f.volume.buffer = larger.volume.buffer = m_bits.handle();
        f.cut = larger.cut = true;
        EXPECT_EQ(pixels(once(larger)), pixels(once(f))) << info->id;
        m_device.waitIdle();
    }
}

TEST_F(ViewsTest, originsThatCannotBeAreRefused) {
    const Images parts = images(true);
    const auto refused = [&](VkOffset2D origin, const char* why) {
        lines().clear();
        EXPECT_EQ(once(frameOf(parts, origin)).status, Result::invalid);
        EXPECT_TRUE(said(why)) << why;
    };
    refused({-2, 0}, "Frame::origin is (-2, 0)");
    refused({3, 0}, "with layers.second of half size it must be even");
    refused({4000, 4000}, "Frame::depth.image has ");
    Frame f = frameOf(parts, kOrigin);
    f.jitter[0] = INFINITY;
    EXPECT_EQ(once(f).status, Result::invalid);
    EXPECT_TRUE(said("Frame::jitter"));
    EXPECT_GT(memoryUse(m_context, frameOf(parts, kOrigin)), memoryUse(m_context, frameOf(parts, {})));
    m_device.waitIdle();
}

// Depth in one mip of one layer, which alone is in the layout that the host names.
TEST_F(ViewsTest, mipsAndLayersThatTheHostNames) {
    const gpu::Api& vk = m_device.vk();
    for (const auto& [mip, layer] : {std::pair(0u, 1u), std::pair(1u, 0u), std::pair(1u, 1u)}) {
        VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = VK_FORMAT_R32_SFLOAT;
        info.extent = {m_room.width << mip, m_room.height << mip, 1};
        info.mipLevels = 2;
        info.arrayLayers = 2;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        VkImage image = VK_NULL_HANDLE;
        ASSERT_EQ(vk.CreateImage(m_device.handle(), &info, nullptr, &image), VK_SUCCESS);
        VkMemoryRequirements needs;
        vk.GetImageMemoryRequirements(m_device.handle(), image, &needs);
        uint32_t type = 0;
        while (!(needs.memoryTypeBits >> type & 1)) ++type;
        const VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size, type};
        VkDeviceMemory memory = VK_NULL_HANDLE;
        ASSERT_EQ(vk.AllocateMemory(m_device.handle(), &allocation, nullptr, &memory), VK_SUCCESS);
        ASSERT_EQ(vk.BindImageMemory(m_device.handle(), image, memory, 0), VK_SUCCESS);
        VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
        viewInfo.image = image;
        viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
        viewInfo.format = info.format;
        viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 1, layer, 1};
        VkImageView view = VK_NULL_HANDLE;
        ASSERT_EQ(vk.CreateImageView(m_device.handle(), &viewInfo, nullptr, &view), VK_SUCCESS);

        gpu::Buffer staging;
        const auto bytes = std::as_bytes(std::span(m_room.depth));
        ASSERT_EQ(gpu::Buffer::create(m_device, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Memory::upload, "staging", staging),
            gpu::Status::ok);
        std::memcpy(staging.mapped(), bytes.data(), bytes.size());
        // All of the image is in GENERAL, but for the part with the depth.
        const auto change = [&](VkCommandBuffer cmd, VkImageSubresourceRange range, VkImageLayout from, VkImageLayout to) {
            VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
            barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
            barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
            barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
            barrier.oldLayout = from;
            barrier.newLayout = to;
            barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
            barrier.image = image;
            barrier.subresourceRange = range;
            VkDependencyInfo list{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
            list.imageMemoryBarrierCount = 1;
            list.pImageMemoryBarriers = &barrier;
            vk.CmdPipelineBarrier2(cmd, &list);
        };
        Frame f = m_room.frame();
        f.volume.buffer = m_bits.handle();
        f.cut = true;
        f.depth = {image, view, info.format, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, mip, layer};
        Output output;
        ASSERT_EQ(m_device.runNow([&](VkCommandBuffer cmd) {
            change(cmd, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 2, 0, 2}, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
            VkBufferImageCopy region{};
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, layer, 1};
            region.imageExtent = {m_room.width, m_room.height, 1};
            vk.CmdCopyBufferToImage(cmd, staging.handle(), image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
            change(cmd, viewInfo.subresourceRange, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
            output = record(m_context, cmd, f);
        }),
            gpu::Status::ok);
        ASSERT_EQ(output.status, Result::ok);
        const std::vector<float> picture = pixels(output);
        f.depth = frame().depth;
        EXPECT_EQ(picture, pixels(once(f))) << "mip " << mip << ", layer " << layer;
        m_device.waitIdle();
        vk.DestroyImageView(m_device.handle(), view, nullptr);
        vk.DestroyImage(m_device.handle(), image, nullptr);
        vk.FreeMemory(m_device.handle(), memory, nullptr);
    }
}

// A still camera whose projection is jittered: motion that contains the jitter, and motion without it and Frame::jitter, give the same
// calm picture.
TEST_F(ViewsTest, motionWithAndWithoutJitterGiveTheSamePicture) {
    const Setting history{"temporal", 0.9f};
    MethodSettings settings;
    settings.settings = {&history, 1};
    ASSERT_EQ(setMethod(m_context, "hbao", settings), Result::ok);
    const float jitters[4][2] = {{0.25f, -0.375f}, {-0.5f, 0.125f}, {0.375f, 0.5f}, {-0.125f, -0.25f}};
    enum class Convention { contained, named, ignored };
    // Mean change from frame to frame of what moves with the jitter; the pictures.
    const auto fly = [&](Convention convention, std::vector<std::vector<float>>& pictures) {
        double change = 0.0;
        for (int i = 0; i < 24; ++i) {
            const float *now = jitters[i % 4], *before = jitters[(i + 3) % 4];
            // The ray of a pixel centre is that of a centre `now` further left and up without jitter.
            test::Room room = m_room;
            room.depth.clear();
            for (uint32_t y = 0; y < room.height; ++y)
                for (uint32_t x = 0; x < room.width; ++x) {
                    const float up = test::rayAt(room, 0.0f, float(y) + 0.5f - now[1])[1];
                    const float z = up < 0.0f ? std::min(room.floor / up, -room.wall) : -room.wall;
                    room.depth.push_back(z);
                }
            const bool contains = convention == Convention::contained;
            std::vector<float> motion;
            for (size_t k = 0; k < room.depth.size(); ++k)
                motion.insert(motion.end(), {contains ? before[0] - now[0] : 0.0f, contains ? before[1] - now[1] : 0.0f});
            const gpu::Image depth = test::Room::uploaded(m_device, VK_FORMAT_R32_SFLOAT, full(), room.depth, "depth");
            const gpu::Image moved = test::Room::uploaded(m_device, VK_FORMAT_R32G32_SFLOAT, full(), motion, "motion");
            Frame f = room.frame();
            f.projection[8] = -2.0f * now[0] / float(room.width);  // clip = P eye, w = -z: moves the image right by now[0] px
            f.projection[9] = -2.0f * now[1] / float(room.height);
            f.depth = {depth.handle(), depth.view(), VK_FORMAT_R32_SFLOAT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
            f.motion = {moved.handle(), moved.view(), VK_FORMAT_R32G32_SFLOAT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
            if (convention == Convention::named) f.jitter[0] = now[0], f.jitter[1] = now[1];
            f.cut = i == 0;
            f.index = uint64_t(i);
            f.volume.buffer = m_bits.handle();
            const Output output = once(f);
            EXPECT_EQ(output.status, Result::ok);
            pictures.push_back(pixels(output));
            m_device.waitIdle();
            if (i < 16) continue;
            // Along the jitter, bilinearly.
            const int width = int(m_room.visibleWidth()), height = int(m_room.visibleHeight());
            const auto last = [&](int x, int y) { return pictures[size_t(i) - 1][size_t(y * width + x)]; };
            for (int y = 1; y < height - 1; ++y)
                for (int x = 1; x < width - 1; ++x) {
                    const float u = float(x) + before[0] - now[0], v = float(y) + before[1] - now[1];
                    const int cx = int(u), cy = int(v);
                    const float fx = u - float(cx), fy = v - float(cy);
                    const float then = (1 - fy) * ((1 - fx) * last(cx, cy) + fx * last(cx + 1, cy)) +
                                       fy * ((1 - fx) * last(cx, cy + 1) + fx * last(cx + 1, cy + 1));
                    change += std::fabs(pictures[size_t(i)][size_t(y * width + x)] - then) / double(8 * (width - 2) * (height - 2));
                }
        }
        return change;
    };
    std::vector<std::vector<float>> contained, named, ignored;
    const double calm = fly(Convention::contained, contained), also = fly(Convention::named, named);
    const double restless = fly(Convention::ignored, ignored);
    std::printf("mean change a frame: motion contains jitter %.5f, Frame::jitter %.5f, neither %.5f\n", calm, also, restless);
    EXPECT_EQ(named, contained);
    EXPECT_GT(restless, 1.2 * calm);
}

}  // namespace
}  // namespace obscura::ao
