// Splits far_field's depth layers into two fields: a background of endless surfaces, scanned like a single depth buffer, and objects
// (surfaces with a known back) in front of it.
#pragma once

#include "ao/methods/far_field/grid.h"

namespace obscura::ao {

class FarFieldLayers {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FarFieldLayers& out);
    // Needs inputs.layers.thickness. `sheet`: thickness of open surfaces that have another surface behind them, metres.
    struct Fields {
        graph::ImageId background;  // R32F, view.size: linear depth
        graph::ImageId objects;     // RG32UI, view.size; layout: shaders/ao/far_field/fields.comp
    };
    Fields split(graph::Graph& graph, const Inputs& inputs, float sheet);
    // Means of objects over intervals of the batch in `constants`, all levels: RG32UI in the grid's order; if directions are paired, of
    // their first half only.
    graph::ImageId scan(graph::Graph& graph, const Inputs& inputs, graph::ImageId objects, graph::BufferId grids, const FarFieldGrid& grid,
        const shared::FarFieldConstants& constants);

private:
    gpu::Program m_split[2], m_scan, m_pyramid;  // m_split: by layer count - 1
};

}  // namespace obscura::ao
