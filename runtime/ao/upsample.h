// Joint bilateral upsampling along the rows, then the columns [Reinbothe, Boubekeur, Alexa 2009, Hybrid Ambient Occlusion, eqs. 5 to 8].
// Costly passes trace a map of fewer pixels than the image; this fills the image along surfaces.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

struct UpsampleSettings {
    uint32_t scale = 2;    // image pixels per map pixel, each way; the map's size is the visible size over this, rounded up
    float window = 16.0f;  // width of the filter, px; at least 2 scale fills the gaps
    float range = 0.5f;    // metres; points farther apart are not averaged
};

class Upsample {
public:
    struct Map {
        graph::ImageId visibility;  // R16F
        graph::ImageId receivers;   // RG32UI, same size: bits of linear depth, packed normal; see receiverOf(), ao/common/map.glsl
    };
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Upsample& out);
    // Returns visibility, R16F, visible size. With `other`, an image of that kind, returns max(0, other - (1 - map)). Pass names begin with
    // `prefix`.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Map& map, const UpsampleSettings& settings, const char* prefix,
        graph::ImageId other = {});

private:
    gpu::Program m_rows, m_columns[2];  // without and with `other`
};

}  // namespace obscura::ao
