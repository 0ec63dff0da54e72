#include "ao/summed_area.h"

#include <cassert>

#include "ao/common/constants.h"

namespace obscura::ao {

Status SummedArea::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, SummedArea& out, uint32_t blocks) {
    if (blocks == 0) blocks = device.caps().software ? 1 : 16;
    const struct {
        const char* name;
        gpu::Program* program;
    } programs[] = {{"ao/common/sum_rows.comp", &out.m_rows}, {"ao/common/sum_columns.comp", &out.m_columns}};
    for (const auto& [name, program] : programs)
        if (gpu::Program::compute(device, shaders, name, {{0, blocks}}, *program) != gpu::Status::ok) return Status::shaderError;
    return Status::ok;
}

void SummedArea::add(graph::Graph& graph, const std::string& name, graph::BufferId texels, graph::BufferId table, shared::uvec2 size) {
    const Layer all{0, 0};
    add(graph, name, texels, texels, table, size, {&all, 1});
}

void SummedArea::add(graph::Graph& graph, const std::string& name, graph::BufferId texels, graph::BufferId codes, graph::BufferId table,
    shared::uvec2 size, std::span<const Layer> layers) {
    assert(!layers.empty() && layers.size() <= kMostLayers);
    shared::SumRows rows{size, uint32_t(layers.size()), 0, {}, {}};
    uint32_t *masks[] = {&rows.masks.x, &rows.masks.y, &rows.masks.z, &rows.masks.w},
             *values[] = {&rows.values.x, &rows.values.y, &rows.values.z, &rows.values.w};
    for (size_t i = 0; i < layers.size(); ++i) {
        *masks[i] = layers[i].mask;
        *values[i] = layers[i].value;
        rows.masked |= layers[i].mask;
    }
    graph.pass(name + " rows", m_rows).read(texels).read(codes).write(table).constants(rows).dispatch(size.y, 1, rows.layers);
    const shared::SumColumns columns{(size.x + 1) * rows.layers, size.y};
    graph.pass(name + " columns", m_columns).write(table).constants(columns).dispatch(columns.columns);
}

}  // namespace obscura::ao
