#include "ao/bent_normals.h"

#include "ao/common/constants.h"

namespace obscura::ao {

Status BentNormals::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, BentNormals& out) {
    const bool made = gpu::Program::compute(device, shaders, "ao/common/bent_normals.comp", {}, out.m_program) == gpu::Status::ok;
    return made ? Status::ok : Status::shaderError;
}

graph::ImageId BentNormals::add(
    graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const RawBentNormals& raw, uint32_t reduced) {
    const shared::uvec2 size = inputs.view.visible;
    const graph::ImageId result = graph.image("bent normals", {VK_FORMAT_R8G8B8A8_SNORM, size.x, size.y});
    // A map is interpolated over at least two of its pixels.
    const uint32_t scale = raw.scale * reduced;
    const float covers = raw.side > 1 ? 0.5f * float(raw.side) + 0.5f : scale > 1 ? 1.0f : 0.5f;
    // Pixels with a weight above 0: one more than the tile where its edges have half weight, or where pixels are between those of a map.
    const uint32_t taps = raw.side % 2 == 0 || scale > 1 ? raw.side + 1 : raw.side;
    graph.pass("bent normals", m_program)
        .read(inputs.viewBlock)
        .read(inputs.depth)
        .read(inputs.normals)
        .read(raw.image)
        .read(visibility)
        .write(result)
        .constants(shared::BentNormals{scale, raw.scale / 2 * reduced, covers, taps})
        .dispatch(size.x, size.y);
    return result;
}

}  // namespace obscura::ao
