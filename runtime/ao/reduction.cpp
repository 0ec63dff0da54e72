#include "ao/reduction.h"

#include "ao/common/constants.h"

namespace obscura::ao {
namespace {

// Reduced pixels are the first of each scale x scale block of the visible part.
shared::View reducedView(const shared::View& view, uint32_t scale) {
    shared::View reduced = view;
    reduced.visible = {(view.visible.x + scale - 1) / scale, (view.visible.y + scale - 1) / scale};
    reduced.guard = {view.guard.x / scale, view.guard.y / scale};
    reduced.size = {reduced.visible.x + 2 * reduced.guard.x, reduced.visible.y + 2 * reduced.guard.y};
    const float s = float(scale);
    // Centre of the frame's pixel = s x centre of the reduced pixel + shift.
    const float shiftX = float(view.guard.x) + 0.5f - s * (float(reduced.guard.x) + 0.5f),
                shiftY = float(view.guard.y) + 0.5f - s * (float(reduced.guard.y) + 0.5f);
    reduced.unproject = {view.unproject.x * s, view.unproject.y * s, view.unproject.z + view.unproject.x * shiftX,
        view.unproject.w + view.unproject.y * shiftY};
    reduced.project = {view.project.x / s, view.project.y / s, (view.project.z - shiftX) / s, (view.project.w - shiftY) / s};
    reduced.pixelsPerMetre = view.pixelsPerMetre / s;
    return reduced;
}

}  // namespace

Status Reduction::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Reduction& out) {
    const bool made = gpu::Program::compute(device, shaders, "ao/common/reduce.comp", {}, out.m_reduce) == gpu::Status::ok &&
                      gpu::Program::compute(device, shaders, "ao/common/enlarge.comp", {}, out.m_enlarge) == gpu::Status::ok;
    return made ? Status::ok : Status::shaderError;
}

Inputs Reduction::reduce(
    gpu::Device& device, const gpu::ShaderLibrary& shaders, graph::Graph& graph, const Inputs& inputs, uint32_t scale) {
    Inputs reduced = inputs;
    reduced.view = reducedView(inputs.view, scale);
    reduced.viewBlock = graph.upload("reduced view", reduced.view);
    reduced.motion = {};  // history is of the frame's pixels
    const shared::uvec2 size = reduced.view.size;
    // Of the frame's pixel that reduced pixel 0 is.
    const VkOffset2D first{
        int32_t(inputs.view.guard.x - reduced.view.guard.x * scale), int32_t(inputs.view.guard.y - reduced.view.guard.y * scale)};
    reduced.depth = graph.image("reduced depth", {VK_FORMAT_R32_SFLOAT, size.x, size.y});
    reduced.normals = graph.image("reduced normals", {VK_FORMAT_R32_UINT, size.x, size.y});
    graph.pass("reduce", m_reduce)
        .read(inputs.depth)
        .read(inputs.normals)
        .write(reduced.depth)
        .write(reduced.normals)
        .constants(shared::Reduce{{first.x, first.y}, shared::sizeOf(size.x, size.y), int32_t(scale), 0})
        .dispatch(size.x, size.y);
    for (graph::ImageId LayerInputs::* layer : {&LayerInputs::thickness, &LayerInputs::second}) {
        const graph::ImageId whole = inputs.layers.*layer;
        if (!whole) continue;
        // A layer of half size has a texel for every other pixel.
        const bool half = graph.desc(whole).width != inputs.view.size.x || graph.desc(whole).height != inputs.view.size.y;
        reduced.layers.*layer = m_layers.add(device, shaders, graph, whole, {first, {size.x, size.y}, scale, half}, Crop::Texel::floats2);
        if (!(reduced.layers.*layer)) return {};
    }
    return reduced;
}

graph::ImageId Reduction::enlarge(
    graph::Graph& graph, const Inputs& inputs, const Inputs& reduced, uint32_t scale, graph::ImageId visibility) {
    const shared::uvec2 visible = inputs.view.visible;
    const graph::ImageId result = graph.image("enlarged visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
    graph.pass("enlarge", m_enlarge)
        .read(inputs.viewBlock)
        .read(inputs.depth)
        .read(inputs.normals)
        .read(reduced.viewBlock)
        .read(reduced.depth)
        .read(reduced.normals)
        .read(visibility)
        .write(result)
        .constants(shared::Enlarge{1.0f / float(scale)})
        .dispatch(visible.x, visible.y);
    return result;
}

}  // namespace obscura::ao
