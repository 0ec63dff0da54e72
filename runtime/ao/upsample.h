// Joint bilateral upsampling along the rows, then the columns [Reinbothe, Boubekeur, Alexa 2009, Hybrid Ambient Occlusion, eqs. 5 to 8]:
// what is costly is traced on a map with a pixel for some of the picture's, whose values are then shared along surfaces.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

struct UpsampleSettings {
    uint32_t scale = 2;    // pixels a map's pixel, each way; the map is the visible size over this, rounded up
    float window = 16.0f;  // width of the filter, px; at least 2 scale fills the gaps
    float range = 0.5f;    // metres beyond which positions share nothing
};

class Upsample {
public:
    struct Map {
        graph::ImageId visibility;  // R16F
        graph::ImageId receivers;   // RG32UI, same size: linear depth as a float's bits and packed normal of receiverOf(), ao/common/map.glsl
    };
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Upsample& out);
    // Returns visibility, R16F, visible size. With `other`, such an image, what the map blocks is taken from it: max(0, other - (1 - map)).
    // Passes are named after `prefix`.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Map& map, const UpsampleSettings& settings, const char* prefix,
                       graph::ImageId other = {});

private:
    gpu::Program m_rows, m_columns[2];  // plain, joining another
};

}  // namespace obscura::ao
