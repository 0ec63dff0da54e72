// Load-time transfers: each records its own commands, runs them and waits. The barriers on both ends span everything, so
// that neither frames still in flight nor later ones need to know of them.
#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "gpu/format_name.h"
#include "gpu/resources.h"
#include "gpu/result.h"

namespace obscura::gpu {

namespace {

constexpr VkAccessFlags2 kAnyAccess = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;

void barrier(
    const Api& vk, VkCommandBuffer cmd, VkPipelineStageFlags2 from, VkAccessFlags2 made, VkPipelineStageFlags2 to, VkAccessFlags2 wanted) {
    const VkMemoryBarrier2 memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, from, made, to, wanted};
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &memory;
    vk.CmdPipelineBarrier2(cmd, &info);
}

void transition(const Api& vk, VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect, uint32_t mip, uint32_t mips,
    VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier2 change{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    change.srcStageMask = change.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    change.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    change.dstAccessMask = kAnyAccess;
    change.oldLayout = from;
    change.newLayout = to;
    change.srcQueueFamilyIndex = change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    change.image = image;
    change.subresourceRange = {aspect, mip, mips, 0, 1};
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &change;
    vk.CmdPipelineBarrier2(cmd, &info);
}

VkOffset3D sizeOf(const ImageDesc& desc, uint32_t mip) {
    const auto side = [mip](uint32_t full) { return int32_t(std::max(1u, full >> mip)); };
    return {side(desc.width), side(desc.height), side(desc.depth)};
}

VkBufferImageCopy wholeOf(const ImageDesc& desc) {
    VkBufferImageCopy region{};
    region.imageSubresource = {aspectOf(desc.format), 0, 0, 1};
    region.imageExtent = {desc.width, desc.height, desc.depth};
    return region;
}

uint64_t bytesOf(const ImageDesc& desc) { return uint64_t(bytesPerTexel(desc.format)) * desc.width * desc.height * desc.depth; }

}  // namespace

Status upload(Device& device, Buffer& buffer, std::span<const std::byte> bytes, uint64_t offset) {
    if (!buffer || offset > buffer.bytes() || bytes.size() > buffer.bytes() - offset)
        return fail(device, Status::invalid,
            fmt::format("upload of {} bytes at {} does not fit a buffer of {}", bytes.size(), offset, buffer.bytes()));
    if (bytes.empty()) return Status::ok;
    if (buffer.mapped()) {
        std::memcpy(buffer.mapped() + offset, bytes.data(), bytes.size());
        return Status::ok;
    }
    Buffer staging;
    if (Status status = Buffer::create(device, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::upload, "staging", staging);
        status != Status::ok)
        return status;
    std::memcpy(staging.mapped(), bytes.data(), bytes.size());
    return device.runNow([&](VkCommandBuffer cmd) {
        const Api& vk = device.vk();
        barrier(vk, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_COPY_BIT,
            VK_ACCESS_2_TRANSFER_WRITE_BIT);
        const VkBufferCopy region{0, offset, bytes.size()};
        vk.CmdCopyBuffer(cmd, staging.handle(), buffer.handle(), 1, &region);
        barrier(vk, cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, kAnyAccess);
    });
}

Status upload(Device& device, Image& image, std::span<const std::byte> texels, VkImageLayout layout) {
    const ImageDesc& desc = image.desc();
    const auto bad = [&](Status status, const std::string& why) {
        return fail(device, status,
            fmt::format("upload to an image ({}x{}x{}, {}): {}", desc.width, desc.height, desc.depth, formatName(desc.format), why));
    };
    if (!image) return bad(Status::invalid, "there is no image");
    if (texels.size() != bytesOf(desc) || texels.empty())
        return bad(Status::invalid, fmt::format("{} bytes given, {} needed", texels.size(), bytesOf(desc)));
    if (!(desc.usage & VK_IMAGE_USAGE_TRANSFER_DST_BIT)) return bad(Status::invalid, "its usage lacks TRANSFER_DST");
    VkFilter filter = VK_FILTER_LINEAR;
    if (desc.mips > 1) {
        constexpr VkFormatFeatureFlags kBlit = VK_FORMAT_FEATURE_BLIT_SRC_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT;
        if (!(desc.usage & VK_IMAGE_USAGE_TRANSFER_SRC_BIT)) return bad(Status::invalid, "making its mips needs TRANSFER_SRC in its usage");
        if (!device.formatSupports(desc.format, kBlit))
            return bad(Status::unsupported, "the device cannot blit this format, so its mips cannot be made");
        if (!device.formatSupports(desc.format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT)) filter = VK_FILTER_NEAREST;
    }
    Buffer staging;
    if (Status status = Buffer::create(device, texels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::upload, "staging", staging);
        status != Status::ok)
        return status;
    std::memcpy(staging.mapped(), texels.data(), texels.size());
    const VkImageAspectFlags aspect = aspectOf(desc.format);
    return device.runNow([&](VkCommandBuffer cmd) {
        const Api& vk = device.vk();
        const VkImage handle = image.handle();
        transition(vk, cmd, handle, aspect, 0, desc.mips, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        const VkBufferImageCopy region = wholeOf(desc);
        vk.CmdCopyBufferToImage(cmd, staging.handle(), handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        for (uint32_t mip = 1; mip < desc.mips; ++mip) {
            transition(vk, cmd, handle, aspect, mip - 1, 1, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
            VkImageBlit blit{};
            blit.srcSubresource = {aspect, mip - 1, 0, 1};
            blit.srcOffsets[1] = sizeOf(desc, mip - 1);
            blit.dstSubresource = {aspect, mip, 0, 1};
            blit.dstOffsets[1] = sizeOf(desc, mip);
            vk.CmdBlitImage(
                cmd, handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, filter);
        }
        if (desc.mips > 1) transition(vk, cmd, handle, aspect, 0, desc.mips - 1, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout);
        transition(vk, cmd, handle, aspect, desc.mips - 1, 1, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout);
    });
}

Status download(Device& device, VkImage image, const ImageDesc& desc, VkImageLayout layout, std::vector<std::byte>& out) {
    out.clear();
    const auto bad = [&](Status status, const std::string& why) {
        return fail(device, status,
            fmt::format("download of an image ({}x{}x{}, {}): {}", desc.width, desc.height, desc.depth, formatName(desc.format), why));
    };
    if (!image || layout == VK_IMAGE_LAYOUT_UNDEFINED) return bad(Status::invalid, "there is no image, or nothing in it yet");
    if (bytesOf(desc) == 0) return bad(Status::unsupported, "texels of unknown size");
    Buffer staging;
    if (Status status = Buffer::create(device, bytesOf(desc), VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::readback, "readback", staging);
        status != Status::ok)
        return status;
    const VkImageAspectFlags aspect = aspectOf(desc.format);
    const Status status = device.runNow([&](VkCommandBuffer cmd) {
        const Api& vk = device.vk();
        transition(vk, cmd, image, aspect, 0, 1, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const VkBufferImageCopy region = wholeOf(desc);
        vk.CmdCopyImageToBuffer(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging.handle(), 1, &region);
        transition(vk, cmd, image, aspect, 0, 1, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout);
        barrier(
            vk, cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    });
    if (status == Status::ok) out.assign(staging.mapped(), staging.mapped() + staging.bytes());
    return status;
}

}  // namespace obscura::gpu
