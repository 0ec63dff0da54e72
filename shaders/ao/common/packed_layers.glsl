// Packed depth layers: one or two layers (obscura/ao.h, DepthLayers) in one texel. A layer is the interval [front, front + length] of the
// view ray, in linear depth. Written by pack_layers.comp. One layer, RG32UI:
//     x: linear depth, bits of a float; y: halves, length of the layer in metres along the camera's axis, and `steepest`
// Two layers, RGBA32UI, the same and:
//     z: length of the second, bits of a float; w: linear depth of the second, bits of a float, 0: none
// Length above 0: a solid; its distance is that to its nearest point, because receivers behind it face its back. Negative length: an open
// sheet or an endless layer; its distance is that to its front.
// Coarser levels are below level 0, see depth_mips.glsl. A texel of level n is a copy of one of its 2^n x 2^n pixels, chosen by row and
// column, so that layers are not averaged and thin objects are not lost. Distant samples then touch fewer cache lines.
#ifndef OBSCURA_PACKED_LAYERS_GLSL
#define OBSCURA_PACKED_LAYERS_GLSL
#include "ao/common/depth_mips.glsl"

const float kEndless = 65504.0;  // length of an endless layer

struct Layers {
    float first, firstLength;    // [first, first + |firstLength|], metres
    float second, secondLength;  // likewise; second 0: none
    float steepest;              // of the first: largest change of depth per metre across the view to another sample on its surface, where
                                 // the metre is one at that sample's depth
};
Layers unpackLayers(uvec4 texel) {
    vec2 halves = unpackHalf2x16(texel.y);
    return Layers(uintBitsToFloat(texel.x), halves.x, uintBitsToFloat(texel.w), uintBitsToFloat(texel.z), halves.y);
}
Layers unpackFirstLayer(uvec2 texel) {
    vec2 halves = unpackHalf2x16(texel.y);
    return Layers(uintBitsToFloat(texel.x), halves.x, 0.0, 0.0, halves.y);
}

// The pixel that the texel of a level that contains pixel q is a copy of; the level for a sample at a distance in pixels.
ivec2 copiedPixel(ivec2 q, int level) {
    int within = (1 << level) - 1;
    return (q & ~within) | (q.yx >> level & within);
}
int levelFor(float pixels) { return clamp((floatBitsToInt(pixels) >> 23) - 127 - 4, 0, kDepthLevels - 1); }

uvec2 packFirstLayer(Layers s) {
    return uvec2(floatBitsToUint(s.first), packHalf2x16(vec2(clamp(s.firstLength, -kEndless, kEndless), s.steepest)));
}
uvec4 packLayers(Layers s) { return uvec4(packFirstLayer(s), floatBitsToUint(s.secondLength), floatBitsToUint(s.second)); }

// Bits of a mask of 32 equal intervals between two places of a range, 0 to 32, rounded.
uint bitsBetween(float from, float to) {
    int first = int(from + 0.5), end = int(to + 0.5);
    return bitfieldInsert(0u, ~0u, first, max(end - first, 0));
}

#endif
