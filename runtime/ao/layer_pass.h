// Packs depth and one or two depth layers into one texel, so that a sample is a single load. A layer is an interval [front, back]
// of the view ray. The pass also gives open sheets a thickness and assigns a second layer of half size to whole pixels at edges.
#pragma once

#include "ao/common/constants.h"
#include "ao/method.h"

namespace obscura::ao {

class LayerPass {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, LayerPass& out);
    // Returns two layers a texel, R32G32B32A32_UINT, or the first alone, R32G32_UINT: view.size and coarser levels beside it; layout:
    // shaders/ao/common/packed_layers.glsl. `sheet`: thickness of surfaces that no back face follows, metres. Needs
    // inputs.layers.thickness.
    enum class Layers : uint8_t { one, two };
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, float sheet, Layers layers = Layers::two);
    // Two layers if the frame has depth layers, for methods in which they are optional; else nothing.
    graph::ImageId addIfGiven(graph::Graph& graph, const Inputs& inputs, const Values& values) {
        return inputs.layers.thickness ? add(graph, inputs, values["sheet"]) : graph::ImageId{};
    }

private:
    gpu::Program m_packFirst, m_packTwo[2];  // [layers in the frame - 1]
};

// Images and first constants that layers_at.glsl reads. Needs inputs.layers.thickness.
struct LayerPackInputs {
    shared::PackLayers constants;
    graph::ImageId thickness, second;  // without a second layer, `second` is `thickness`
    uint32_t layerCount;               // 1 or 2
};
LayerPackInputs layerPackInputs(graph::Graph& graph, const Inputs& inputs, float sheet, bool onlyFirst = false);

// Parameters of methods for which depth layers are optional. Renderers and layerModeOf() find the first by its id.
inline constexpr Parameter kDepthLayers{"depth_layers", "", 0, 3, 0, true, {kLayerModes, 4},
    "Reads depth layers: the thickness of the visible surface, or also a second surface at half or full size. Finite objects then stop "
    "occluding behind their back faces. Each layer costs geometry passes; with none, foreground objects get dark halos."};
inline constexpr Parameter kSheet{"sheet", "m", 0, 100, 0.05f, false, {},
    "Thickness of open sheets, surfaces that no back face follows, where depth layers are read. Too low: leaves and cloth occlude too "
    "little; too high: dark halos around them."};

// Blocking of a method that reads depth layers if the frame has them, else `bare`.
inline Blocking blockingWithLayers(Blocking bare, const Inputs& inputs, const Values& values) {
    if (inputs.layers.thickness) bare.sheet = values["sheet"];
    return bare;
}

}  // namespace obscura::ao
