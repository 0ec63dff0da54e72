#include "ao/methods/far_field/layers.h"

#include "ao/layer_pass.h"

namespace obscura::ao {

gpu::Status FarFieldLayers::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FarFieldLayers& out) {
    for (uint32_t layers = 1; layers <= 2; ++layers)
        if (const gpu::Status status =
                gpu::Program::compute(device, shaders, "ao/far_field/fields.comp", {{0, layers}}, out.m_split[layers - 1]);
            status != gpu::Status::ok)
            return status;
    if (const gpu::Status status = gpu::Program::compute(device, shaders, "ao/far_field/objects.comp", {}, out.m_scan);
        status != gpu::Status::ok)
        return status;
    return gpu::Program::compute(device, shaders, "ao/far_field/objects_pyramid.comp", {}, out.m_pyramid);
}

FarFieldLayers::Fields FarFieldLayers::split(graph::Graph& graph, const Inputs& inputs, float sheet) {
    const shared::uvec2 size = inputs.view.size;
    const LayerPackInputs packing = layerPackInputs(graph, inputs, sheet);
    const Fields fields{graph.image("far_field.background", {VK_FORMAT_R32_SFLOAT, size.x, size.y}),
        graph.image("far_field.objects", {VK_FORMAT_R32G32_UINT, size.x, size.y})};
    graph.pass("far_field.fields", m_split[packing.layerCount - 1])
        .read(inputs.viewBlock)
        .read(inputs.depth)
        .read(inputs.normals)
        .read(packing.thickness)
        .read(packing.second)
        .write(fields.background)
        .write(fields.objects)
        .constants(shared::FarFieldFields{packing.constants, inputs.falloffDesc.length})
        .dispatch(size.x, size.y);
    return fields;
}

graph::ImageId FarFieldLayers::scan(graph::Graph& graph, const Inputs& inputs, graph::ImageId objects, graph::BufferId grids,
    const FarFieldGrid& grid, const shared::FarFieldConstants& constants) {
    const shared::Direction& last = grid.directions[constants.first + constants.count - 1];
    const graph::ImageId cells = graph.image("far_field.object cells",
        {VK_FORMAT_R32G32_UINT, shared::kCellsWide, (last.base + last.total + shared::kCellsWide - 1) / shared::kCellsWide});
    graph.pass("far_field.objects", m_scan)
        .read(inputs.viewBlock)
        .read(objects)
        .read(grids)
        .write(cells)
        .constants(constants)
        .dispatch(grid.lines, grid.intervals, constants.count);
    for (uint32_t level = 1; level < grid.levels; ++level)
        graph.pass("far_field.objects pyramid", m_pyramid)
            .read(grids)
            .write(cells)
            .constants(shared::FarFieldObjectPyramid{constants.first, level})
            .dispatch(grid.lines >> level, grid.intervals >> level, constants.count);
    return cells;
}

}  // namespace obscura::ao
