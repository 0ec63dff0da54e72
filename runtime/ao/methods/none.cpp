// No obscurance: visibility 1 everywhere. What every other method's cost and picture is compared with.
#include "ao/method.h"

namespace obscura::ao {
namespace {

const Preset kPresets[] = {{"default", "Nothing is computed.", {}}};
const MethodInfo kInfo{"none", "No obscurance", "", "Ambient light reaches every point: the picture without any of this.", 0, {}, {kPresets, 1}};

class None final : public Method {
public:
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Values&) override {
        const graph::ImageId visibility = graph.image("none.visibility", {VK_FORMAT_R16_SFLOAT, inputs.view.visible.x, inputs.view.visible.y});
        graph.pass("none.clear").use(visibility, graph::Access::transferWrite, true).record([visibility](const graph::PassContext& c) {
            const VkClearColorValue open{{1.0f, 1.0f, 1.0f, 1.0f}};
            const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
            c.device.vk().CmdClearColorImage(c.cmd, c.image(visibility), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &open, 1, &range);
        });
        return visibility;
    }
};

}  // namespace

MethodEntry noneEntry() {
    return {&kInfo, [](gpu::Device&, const gpu::ShaderLibrary&) -> std::unique_ptr<Method> { return std::make_unique<None>(); }};
}

}  // namespace obscura::ao
