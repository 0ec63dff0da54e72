// Depth layers as methods sample them: one texel holds depth, normal and up to two spans of matter along the view ray. One load serves
// for all of it, and what layers leave unsaid is settled once a pixel: how thick open sheets are, what a second surface of half size
// means at an edge.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

class SpansPass {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, SpansPass& out);
    // Two spans a texel, R32G32B32A32_UINT, or the first alone, R32G32_UINT: view.size and coarser levels beside it, laid out as
    // shaders/ao/common/spans.glsl says. `sheet`: how thick surfaces are that no back face follows, metres. The frame has a first layer.
    enum class Spans : uint8_t { one, two };
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, float sheet, Spans spans = Spans::two);

private:
    gpu::Program m_one, m_two[2];  // by the layers that there are
};

// The images that spans_at.glsl reads of a frame that has depth layers, and its first constants.
struct LayerReading {
    struct { float sheet; uint32_t shift; } packing;  // Packing there: metres; 1 where the second layer is of half size
    graph::ImageId thickness, second;  // where there is no second, the first again
    uint32_t layers;  // that there are, 1 or 2
};
LayerReading readLayers(graph::Graph& graph, const Inputs& inputs, float sheet, bool onlyFirst = false);

// What a method that can do without has of them. Named as renderers and layersOf() look for it.
inline constexpr Parameter kDepthLayers{"depth_layers", "", 0, 3, 0, true, {kLayerChoices, 4},
                                        "What is read of what lies behind the visible surface, so that things end where they do; each more costs geometry passes."};
inline constexpr Parameter kSheet{"sheet", "m", 0, 100, 0.05f, false, {}, "How thick open surfaces are where depth layers are read: those that no back face follows."};

// What blocks for a method that reads depth layers wherever the frame has them, and else takes for solid what `bare` says.
inline Blocking blockingOfSpans(Blocking bare, const Inputs& inputs, const Values& values) {
    if (inputs.layers.thickness) bare.sheet = values["sheet"];
    return bare;
}

}  // namespace obscura::ao
