// far_field's two fields: what depth layers tell of a picture, split into a background that is scanned as single layers are, and things before it.
#pragma once

#include "far_field_parts.h"

namespace obscura::ao {

class LayerFields {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, LayerFields& out);
    // Of the frame's depth layers, which there must be. `sheet`: how thick open surfaces are before another one, metres.
    struct Fields {
        graph::ImageId background;  // R32F, view.size: linear depth
        graph::ImageId things;      // RG32UI, view.size: shaders/ao/far_field/fields.comp
    };
    Fields split(graph::Graph& graph, const Inputs& inputs, float sheet);
    // Means of things over intervals, all levels: RG32UI in a grid's order, of the first half of directions where they are paired.
    graph::ImageId scan(graph::Graph& graph, const Inputs& inputs, graph::ImageId things, graph::BufferId grids, const FarFieldGrid& grid,
                        const shared::FarFieldConstants& constants);

private:
    gpu::Program m_split[2], m_scan, m_pyramid;  // by layers
};

}  // namespace obscura::ao
