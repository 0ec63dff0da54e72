#include "app/capture.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

namespace obscura::app {

namespace {

Picture convert(const gpu::ImageDesc& desc, const std::byte* bytes) {
    Picture picture{desc.width, desc.height, {}};
    const size_t count = size_t(desc.width) * desc.height;
    picture.rgba.resize(count * 4);
    if (desc.format == VK_FORMAT_R8G8B8A8_UNORM) {
        std::memcpy(picture.rgba.data(), bytes, picture.rgba.size());
        return picture;
    }
    for (size_t i = 0; i < count; ++i) {
        uint16_t half;
        std::memcpy(&half, bytes + 2 * i, 2);
        const float value = glm::unpackHalf1x16(half);
        // A NaN becomes black: casting it to an integer is undefined.
        const auto grey = uint8_t(std::isnan(value) ? 0.0f : std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
        std::fill_n(picture.rgba.begin() + long(4 * i), 3, grey);
        picture.rgba[4 * i + 3] = 255;
    }
    return picture;
}

}  // namespace

gpu::Status Capture::add(graph::Graph& graph, graph::ImageId image, Done done) {
    const gpu::ImageDesc desc = graph.desc(image);
    if (desc.format != VK_FORMAT_R8G8B8A8_UNORM && desc.format != VK_FORMAT_R16_SFLOAT) return gpu::Status::unsupported;
    return addRaw(graph, image, [desc, done = std::move(done)](std::span<const std::byte> bytes) { done(convert(desc, bytes.data())); });
}

gpu::Status Capture::addRaw(graph::Graph& graph, graph::ImageId image, Raw done) {
    const gpu::ImageDesc desc = graph.desc(image);
    const uint64_t bytes = uint64_t(desc.width) * desc.height * gpu::bytesPerTexel(desc.format);
    Pending pending{m_device.frame(), {}, std::move(done)};
    const auto fits = std::find_if(m_free.begin(), m_free.end(), [&](const gpu::Buffer& b) { return b.bytes() == bytes; });
    if (fits != m_free.end()) {
        pending.buffer = std::move(*fits);
        m_free.erase(fits);
    } else {
        m_free.clear();  // buffers of an earlier image size
        const gpu::Status status =
            gpu::Buffer::create(m_device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback, kPass, pending.buffer);
        if (status != gpu::Status::ok) return status;
    }

    const VkBuffer target = pending.buffer.handle();
    const graph::BufferId buffer = graph.import(kPass, pending.buffer, graph::Graph::Shared::written);
    graph.pass(kPass)
        .use(image, graph::Access::transferRead)
        .use(buffer, graph::Access::transferWrite)
        .keep()
        .record([=](const graph::PassContext& context) {
            const VkBufferImageCopy region{
                .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, .imageExtent = {desc.width, desc.height, 1}};
            const gpu::Api& vk = context.device.vk();
            vk.CmdCopyImageToBuffer(context.cmd, context.image(image), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target, 1, &region);
            // The fence alone does not make device writes visible to the host.
            const VkMemoryBarrier2 toHost{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                .srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
            const VkDependencyInfo dependency{
                .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &toHost};
            vk.CmdPipelineBarrier2(context.cmd, &dependency);
        });
    m_pending.push_back(std::move(pending));
    return gpu::Status::ok;
}

void Capture::collect(bool all) {
    while (!m_pending.empty() && (all || m_pending.front().frame + m_device.framesInFlight() <= m_device.frame())) {
        Pending pending = std::move(m_pending.front());
        m_pending.pop_front();
        pending.done({pending.buffer.mapped(), size_t(pending.buffer.bytes())});
        m_free.push_back(std::move(pending.buffer));
    }
}

}  // namespace obscura::app
