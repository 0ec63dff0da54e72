// Copies images of a graph to the CPU.
#pragma once

#include <gtest/gtest.h>

#include "gpu/resources.h"
#include "graph/graph.h"

namespace obscura::test {

// Adds a pass that copies mip 0 of an image into a new buffer; after the frame has finished its mapped() holds the rows without padding.
inline gpu::Buffer readBack(graph::Graph& graph, graph::ImageId image) {
    const gpu::ImageDesc desc = graph.desc(image);
    gpu::Buffer buffer;
    EXPECT_EQ(gpu::Buffer::create(graph.device(), uint64_t(desc.width) * desc.height * gpu::bytesPerTexel(desc.format),
                  VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback, "read back", buffer),
        gpu::Status::ok);
    const graph::BufferId target = graph.import("read back", buffer, graph::Graph::Shared::written);
    const VkBufferImageCopy region{0, 0, 0, {gpu::aspectOf(desc.format), 0, 0, 1}, {}, {desc.width, desc.height, 1}};
    graph.pass("read back")
        .use(image, graph::Access::transferRead)
        .use(target, graph::Access::transferWrite)
        .keep()
        .record([image, region, to = buffer.handle()](const graph::PassContext& c) {
            c.device.vk().CmdCopyImageToBuffer(c.cmd, c.image(image), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to, 1, &region);
        });
    return buffer;
}

}  // namespace obscura::test
