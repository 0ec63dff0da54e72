// Packs depth and depth layers into one texel; layout: packed_layers.glsl.
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
    ivec2 q = ivec2(gl_GlobalInvocationID.xy), padded = paddedSize(view.size), last = ivec2(view.size) - 1;
    vec3 normal;
    Layers result = layersOfPixel(view, constants, min(q, last), normal);
#ifdef ONE_LAYER
    uvec4 texel = uvec4(packFirstLayer(result), 0u, 0u);
#else
    uvec4 texel = packLayers(result);
#endif
    imageStore(packedLayers, q, texel);
    for (int level = 1; level < kDepthLevels; ++level)
        if (copiedPixel(q, level) == q) imageStore(packedLayers, mipTexel(padded, q, level), texel);
}
