// Packs depth, normal and depth layers into one texel; layout: packed_layers.glsl.
// In: depth, normals, depth layers. Out: RGBA32UI, or RG32UI with ONE_LAYER.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant ONE_LAYER
#include "ao/common/layers_at.glsl"
#ifdef ONE_LAYER
layout(set = 0, binding = 5, rg32ui) uniform writeonly uimage2D packedLayers;
#else
layout(set = 0, binding = 5, rgba32ui) uniform writeonly uimage2D packedLayers;
#endif
layout(push_constant) uniform Block { PackLayers constants; };

void main() {
    View view = viewBlock;
    // All levels: each texel is packed from its pixel, see pixelIn().
    ivec2 stored = ivec2(gl_GlobalInvocationID.xy), padded = paddedSize(view.size), last = ivec2(view.size) - 1, cell;
    int level = mipAt(padded, stored, cell);
    if (any(greaterThan(cell << level, last))) return;
    uint normal;
    Layers result = layersOfPixel(view, constants, pixelIn(cell, level, last), normal);
#ifdef ONE_LAYER
    imageStore(packedLayers, stored, uvec4(packFirstLayer(result, normal), 0u, 0u));
#else
    imageStore(packedLayers, stored, packLayers(result, normal));
#endif
}
