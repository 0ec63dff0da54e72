#include "ao/method.h"

namespace obscura::ao {

graph::ImageId allOpen(graph::Graph& graph, VkExtent2D visible, const char* passName) {
    const graph::ImageId visibility = graph.image(passName, {VK_FORMAT_R16_SFLOAT, visible.width, visible.height});
    graph.pass(passName).use(visibility, graph::Access::transferWrite, true).record([visibility](const graph::PassContext& c) {
        const VkClearColorValue open{{1.0f, 1.0f, 1.0f, 1.0f}};
        const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        c.device.vk().CmdClearColorImage(c.cmd, c.image(visibility), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &open, 1, &range);
    });
    return visibility;
}

graph::ImageId rawBentNormals(graph::Graph& graph, uint32_t width, uint32_t height, const char* name) {
    return graph.image(name, {VK_FORMAT_R32G32_UINT, width, height});
}

}  // namespace obscura::ao
