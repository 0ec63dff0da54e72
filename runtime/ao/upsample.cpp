#include "ao/upsample.h"

#include <string>

#include "ao/common/constants.h"

namespace obscura::ao {

Status Upsample::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Upsample& out) {
    if (gpu::Program::compute(device, shaders, "ao/common/upsample_rows.comp", {}, out.m_rows) != gpu::Status::ok)
        return Status::shaderError;
    for (uint32_t joins = 0; joins < 2; ++joins)
        if (gpu::Program::compute(device, shaders, "ao/common/upsample_columns.comp", {{0, joins}}, out.m_columns[joins]) !=
            gpu::Status::ok)
            return Status::shaderError;
    return Status::ok;
}

graph::ImageId Upsample::add(
    graph::Graph& graph, const Inputs& inputs, const Map& map, const UpsampleSettings& settings, const char* prefix, graph::ImageId other) {
    const uint32_t width = graph.desc(map.visibility).width, height = graph.desc(map.visibility).height;
    const shared::Upsample constants{shared::sizeOf(width, height), int32_t(settings.scale), settings.window, settings.range, 0};
    const auto& visible = inputs.view.visible;
    const std::string name = prefix;
    const graph::ImageId rows = graph.image(name + ".rows", {VK_FORMAT_R16_SFLOAT, visible.x, height});
    const graph::ImageId visibility = graph.image(name + ".visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
    graph.pass(name + ".rows", m_rows)
        .read(inputs.viewBlock)
        .read(inputs.depth)
        .read(inputs.normals)
        .read(map.visibility)
        .read(map.receivers)
        .write(rows)
        .constants(constants)
        .dispatch(visible.x, height);
    graph.pass(name + ".columns", m_columns[other ? 1 : 0])
        .read(inputs.viewBlock)
        .read(inputs.depth)
        .read(inputs.normals)
        .read(rows)
        .read(other ? other : rows)
        .write(visibility)
        .constants(constants)
        .dispatch(visible.x, visible.y);
    return visibility;
}

}  // namespace obscura::ao
