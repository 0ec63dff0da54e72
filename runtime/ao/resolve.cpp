#include "ao/resolve.h"

#include <algorithm>
#include <string>

namespace obscura::ao {
namespace {

struct Reprojection {  // temporal.comp
    float previousFromEye[12];
    float motionScale[2];
    float history, depthTolerance, normalTolerance, clip, clipFloor;
    uint32_t valid;
};

}  // namespace

graph::ImageId allOpen(graph::Graph& graph, VkExtent2D visible, const char* passName) {
    const graph::ImageId visibility = graph.image(passName, {VK_FORMAT_R16_SFLOAT, visible.width, visible.height});
    graph.pass(passName).use(visibility, graph::Access::transferWrite, true).record([visibility](const graph::PassContext& c) {
        const VkClearColorValue open{{1.0f, 1.0f, 1.0f, 1.0f}};
        const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        c.device.vk().CmdClearColorImage(c.cmd, c.image(visibility), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &open, 1, &range);
    });
    return visibility;
}

Status Denoise::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Denoise& out) {
    const bool made = gpu::Program::compute(device, shaders, "ao/common/denoise.comp", {{0, 0}}, out.m_blur) == gpu::Status::ok &&
                      gpu::Program::compute(device, shaders, "ao/common/denoise.comp", {{0, 1}}, out.m_strict) == gpu::Status::ok;
    return made ? Status::ok : Status::shaderError;
}

graph::ImageId Denoise::add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const char* passName) {
    const graph::ImageId result = graph.image(passName, graph.desc(visibility));
    graph.pass(passName, inputs.view.temporal ? m_strict : m_blur).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(visibility).write(result)
        .dispatch(inputs.view.visible.x, inputs.view.visible.y);
    return result;
}

uint32_t tileSide(const Values& values) { return values.count(kInterleave.id) + 1; }

uint32_t sharedOut(uint32_t directions, uint32_t side) {
    const uint32_t shares = side * side;
    return (directions + shares - 1) / shares * shares;
}

Status Gather::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Gather& out) {
    const bool made = gpu::Program::compute(device, shaders, "ao/common/gather.comp", {{0, 0}}, out.m_equal) == gpu::Status::ok &&
                      gpu::Program::compute(device, shaders, "ao/common/gather.comp", {{0, 1}}, out.m_weighted) == gpu::Status::ok &&
                      gpu::Program::compute(device, shaders, "ao/common/gather_map.comp", {}, out.m_map) == gpu::Status::ok;
    return made ? Status::ok : Status::shaderError;
}

graph::ImageId Gather::add(graph::Graph& graph, const Inputs& inputs, graph::ImageId parts, uint32_t side, graph::ImageId open) {
    const shared::uvec2 size = inputs.view.visible;
    const graph::ImageId result = graph.image("resolve.gather", {VK_FORMAT_R16_SFLOAT, size.x, size.y});
    graph.pass("resolve.gather", open ? m_weighted : m_equal).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(parts)
        .read(open ? open : parts).write(result).constants(side).dispatch(size.x, size.y);
    return result;
}

graph::ImageId Gather::addMap(graph::Graph& graph, const Inputs& inputs, graph::ImageId parts, graph::ImageId receivers, uint32_t scale, uint32_t side) {
    const struct { uint32_t side; float scale; } constants{side, float(scale)};
    const graph::ImageId result = graph.image("resolve.gather", graph.desc(parts));
    graph.pass("resolve.gather", m_map).read(inputs.viewBlock).read(receivers).read(parts).read(parts).write(result).constants(constants)
        .dispatch(graph.desc(parts).width, graph.desc(parts).height);
    return result;
}

Status Temporal::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Temporal& out) {
    return gpu::Program::compute(device, shaders, "ao/common/temporal.comp", {}, out.m_reproject) == gpu::Status::ok ? Status::ok : Status::shaderError;
}

graph::ImageId Temporal::add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const TemporalSettings& settings, const char* passName) {
    if (!inputs.motion || settings.history <= 0.0f) {
        if (!graph.rehearsal()) reset();  // what is there ages unseen
        return visibility;
    }
    const shared::uvec2 size = inputs.view.visible;
    const auto past = graph.history(std::string(passName) + " past", {VK_FORMAT_R32G32_UINT, size.x, size.y}, m_past);
    Reprojection constants{};
    std::copy_n(inputs.previousFromEye, 12, constants.previousFromEye);
    std::copy_n(inputs.motionScale, 2, constants.motionScale);
    constants.history = std::min(settings.history, 0.98f);
    constants.depthTolerance = settings.depthTolerance;
    constants.normalTolerance = settings.normalTolerance;
    constants.clip = settings.clip;
    constants.clipFloor = settings.clipFloor;
    constants.valid = past.valid ? 1 : 0;
    const graph::ImageId result = graph.image(passName, graph.desc(visibility));
    graph.pass(passName, m_reproject).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(inputs.motion).read(visibility)
        .read(past.previous).write(result).write(past.current).constants(constants).dispatch(size.x, size.y);
    return result;
}

void Temporal::reset() {
    m_past.invalidate();
}

}  // namespace obscura::ao
