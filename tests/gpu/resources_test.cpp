// gpu::Buffer and gpu::Image: uploads, downloads, mips, refused descriptions, memory use.
#include <algorithm>
#include <cstring>

#include "gpu/resources.h"
#include "gpu/test_device.h"

using namespace obscura;
using namespace obscura::gpu;

namespace {

class ResourcesTest : public test::GpuTest {};

constexpr VkImageUsageFlags kTexture = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;

std::vector<std::byte> pattern(size_t bytes) {
    std::vector<std::byte> data(bytes);
    for (size_t i = 0; i < bytes; ++i) data[i] = std::byte((i * 37 + i / 251) & 0xff);
    return data;
}

std::vector<std::byte> readBack(Device& device, const Buffer& buffer) {
    Buffer staging;
    EXPECT_EQ(Buffer::create(device, buffer.bytes(), VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::readback, "readback", staging), Status::ok);
    EXPECT_EQ(device.runNow([&](VkCommandBuffer cmd) {
        const VkBufferCopy region{0, 0, buffer.bytes()};
        device.vk().CmdCopyBuffer(cmd, buffer.handle(), staging.handle(), 1, &region);
        const VkMemoryBarrier2 memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, VK_PIPELINE_STAGE_2_COPY_BIT,
            VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};
        VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        info.memoryBarrierCount = 1;
        info.pMemoryBarriers = &memory;
        device.vk().CmdPipelineBarrier2(cmd, &info);
    }),
        Status::ok);
    return {staging.mapped(), staging.mapped() + staging.bytes()};
}

TEST_F(ResourcesTest, DeviceBufferRoundTrips) {
    Device& device = test::device();
    Buffer buffer;
    ASSERT_EQ(Buffer::create(device, 4096, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device, "data", buffer), Status::ok);
    EXPECT_EQ(buffer.mapped(), nullptr);
    std::vector<std::byte> data = pattern(4096);
    ASSERT_EQ(upload(device, buffer, data), Status::ok);
    const std::vector<std::byte> patch(16, std::byte{0xee});
    ASSERT_EQ(upload(device, buffer, patch, 100), Status::ok);
    std::copy(patch.begin(), patch.end(), data.begin() + 100);
    EXPECT_EQ(readBack(device, buffer), data);
}

TEST_F(ResourcesTest, MappedBufferIsWrittenInPlace) {
    Device& device = test::device();
    Buffer buffer;
    ASSERT_EQ(Buffer::create(device, 256, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, Memory::upload, "constants", buffer), Status::ok);
    ASSERT_NE(buffer.mapped(), nullptr);
    const std::vector<std::byte> data = pattern(256);
    ASSERT_EQ(upload(device, buffer, data), Status::ok);
    EXPECT_EQ(std::memcmp(buffer.mapped(), data.data(), 256), 0);
}

TEST_F(ResourcesTest, UploadBeyondTheEndIsRefused) {
    Device& device = test::device();
    Buffer buffer;
    ASSERT_EQ(Buffer::create(device, 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device, "small", buffer), Status::ok);
    EXPECT_EQ(upload(device, buffer, pattern(65)), Status::invalid);
    EXPECT_EQ(upload(device, buffer, pattern(1), 64), Status::invalid);
    EXPECT_EQ(upload(device, buffer, pattern(1), ~0ull), Status::invalid);
    EXPECT_EQ(upload(device, buffer, {}, 64), Status::ok);
}

TEST_F(ResourcesTest, ImageRoundTrips) {
    Device& device = test::device();
    for (VkFormat format : {VK_FORMAT_R8_UNORM, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}) {
        Image image;
        ASSERT_EQ(Image::create(device, {format, 13, 7, 1, 1, kTexture}, "odd", image), Status::ok);
        const std::vector<std::byte> texels = pattern(size_t(13) * 7 * bytesPerTexel(format));
        ASSERT_EQ(upload(device, image, texels, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL), Status::ok);
        std::vector<std::byte> back;
        ASSERT_EQ(download(device, image.handle(), image.desc(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, back), Status::ok);
        EXPECT_EQ(back, texels) << int(format);
    }
}

TEST_F(ResourcesTest, DepthAndVolumeImagesRoundTrip) {
    Device& device = test::device();
    for (const ImageDesc& desc :
        {ImageDesc{VK_FORMAT_D32_SFLOAT, 16, 9, 1, 1, kTexture}, ImageDesc{VK_FORMAT_R8_UNORM, 8, 4, 6, 1, kTexture}}) {
        Image image;
        ASSERT_EQ(Image::create(device, desc, "deep", image), Status::ok);
        std::vector<std::byte> texels;
        if (desc.format == VK_FORMAT_D32_SFLOAT) {
            std::vector<float> depths(16 * 9);
            for (size_t i = 0; i < depths.size(); ++i) depths[i] = float(i) / float(depths.size());
            texels.resize(depths.size() * sizeof(float));
            std::memcpy(texels.data(), depths.data(), texels.size());
        } else {
            texels = pattern(8 * 4 * 6);
        }
        ASSERT_EQ(upload(device, image, texels, VK_IMAGE_LAYOUT_GENERAL), Status::ok);
        std::vector<std::byte> back;
        ASSERT_EQ(download(device, image.handle(), desc, VK_IMAGE_LAYOUT_GENERAL, back), Status::ok);
        EXPECT_EQ(back, texels);
    }
}

TEST_F(ResourcesTest, MipsAreAverages) {
    Device& device = test::device();
    Image image;
    ASSERT_EQ(Image::create(device, {VK_FORMAT_R8G8B8A8_UNORM, 8, 8, 1, 4, kTexture}, "chain", image), Status::ok);
    EXPECT_NE(image.mipView(0), image.view());
    EXPECT_NE(image.mipView(3), VK_NULL_HANDLE);
    std::vector<std::byte> texels(8 * 8 * 4);
    for (size_t i = 0; i < texels.size(); ++i) texels[i] = std::byte((i / 4) % 2 ? 200 : 100);  // columns
    ASSERT_EQ(upload(device, image, texels, VK_IMAGE_LAYOUT_GENERAL), Status::ok);
    std::vector<std::byte> last;
    // download() reads mip 0, so the smallest mip is copied into another image.
    Image one;
    ASSERT_EQ(Image::create(device, {VK_FORMAT_R8G8B8A8_UNORM, 1, 1, 1, 1, kTexture}, "one", one), Status::ok);
    ASSERT_EQ(upload(device, one, pattern(4), VK_IMAGE_LAYOUT_GENERAL), Status::ok);
    ASSERT_EQ(device.runNow([&](VkCommandBuffer cmd) {
        VkImageCopy copy{};
        copy.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 3, 0, 1};
        copy.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.extent = {1, 1, 1};
        device.vk().CmdCopyImage(cmd, image.handle(), VK_IMAGE_LAYOUT_GENERAL, one.handle(), VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
    }),
        Status::ok);
    ASSERT_EQ(download(device, one.handle(), one.desc(), VK_IMAGE_LAYOUT_GENERAL, last), Status::ok);
    for (std::byte channel : last) EXPECT_NEAR(int(channel), 150, 2);
}

TEST_F(ResourcesTest, InvalidImagesAreRefusedWithALogLine) {
    Device& device = test::device();
    const uint64_t before = device.memoryUse();
    Image image;
    EXPECT_EQ(Image::create(device, {VK_FORMAT_R8_UNORM, 0, 4, 1, 1, kTexture}, "flat", image), Status::invalid);
    EXPECT_EQ(Image::create(device, {VK_FORMAT_R8_UNORM, 8, 8, 1, 5, kTexture}, "mips", image), Status::invalid);
    EXPECT_EQ(Image::create(device, {VK_FORMAT_UNDEFINED, 8, 8, 1, 1, kTexture}, "format", image), Status::invalid);
    EXPECT_EQ(
        Image::create(device, {VK_FORMAT_R8_UNORM, device.caps().maxImageSize + 1, 8, 1, 1, kTexture}, "wide", image), Status::unsupported);
    EXPECT_EQ(Image::create(device, {VK_FORMAT_D32_SFLOAT, 8, 8, 1, 1, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}, "depth as colour", image),
        Status::unsupported);
    EXPECT_FALSE(image);
    EXPECT_EQ(test::logged().size(), 5u) << test::allLogged();
    EXPECT_TRUE(test::loggedContains("image 'depth as colour'"));
    EXPECT_EQ(device.memoryUse(), before);
}

TEST_F(ResourcesTest, WrongAmountOfTexelsIsRefused) {
    Device& device = test::device();
    Image image;
    ASSERT_EQ(Image::create(device, {VK_FORMAT_R8_UNORM, 8, 8, 1, 1, kTexture}, "texels", image), Status::ok);
    EXPECT_EQ(upload(device, image, pattern(63), VK_IMAGE_LAYOUT_GENERAL), Status::invalid);
    std::vector<std::byte> back;
    EXPECT_EQ(download(device, image.handle(), image.desc(), VK_IMAGE_LAYOUT_UNDEFINED, back), Status::invalid);
}

TEST_F(ResourcesTest, MemoryUseReturnsAfterMovesAndReleases) {
    Device& device = test::device();
    device.waitIdle();
    const uint64_t before = device.memoryUse();
    {
        Image a, b;
        ASSERT_EQ(Image::create(device, {VK_FORMAT_R8G8B8A8_UNORM, 64, 64, 1, 7, kTexture}, "a", a), Status::ok);
        b = std::move(a);
        EXPECT_FALSE(a);  // NOLINT(bugprone-use-after-move): what a move leaves behind is tested
        EXPECT_TRUE(b);
        ASSERT_EQ(Image::create(device, {VK_FORMAT_R8G8B8A8_UNORM, 32, 32, 1, 1, kTexture}, "b again", b), Status::ok);
        Buffer c;
        ASSERT_EQ(Buffer::create(device, 1000, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::upload, "c", c), Status::ok);
        EXPECT_EQ(Buffer::create(device, 0, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::upload, "none", c), Status::invalid);
        EXPECT_FALSE(c);
        EXPECT_GT(device.memoryUse(), before);
    }
    device.waitIdle();
    EXPECT_EQ(device.memoryUse(), before);
}

}  // namespace
