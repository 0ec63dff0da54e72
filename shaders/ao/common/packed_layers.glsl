// Packed depth layers: depth, normal and one or two layers (obscura/ao.h, DepthLayers) in one texel. A layer is the interval
// [front, front + length] of the view ray, in linear depth. Written by pack_layers.comp.
// Two layers, RGBA32UI:
//     x: linear depth, bits of a float; y: packed normal; z: halves, lengths of the first and the second layer, metres along the
//     camera's axis; w: linear depth of the second, bits of a float, 0: none
// One layer, RG32UI:
//     x: linear depth, bits of a float; y: octahedral normal in two signed bytes, above them the length as a half
// Length above 0: a solid; its distance is that to its nearest point, because receivers behind it face its back. Negative length: an open
// sheet or an endless layer; its distance is that to its front.
// Coarser levels are beside level 0, see depth_mips.glsl. A texel of level n is a copy of one of its 2^n x 2^n pixels, chosen by row and
// column, so that layers are not averaged and thin objects are not lost. Distant samples then touch fewer cache lines.
#ifndef OBSCURA_PACKED_LAYERS_GLSL
#define OBSCURA_PACKED_LAYERS_GLSL
#include "ao/common/depth_mips.glsl"
#include "shared/octahedral.glsl"

const float kEndless = 65504.0;  // length of an endless layer

struct Layers {
    float first, firstLength;    // [first, first + |firstLength|], metres
    float second, secondLength;  // likewise; second 0: none
};
Layers unpackLayers(uvec4 texel) {
    vec2 lengths = unpackHalf2x16(texel.z);
    return Layers(uintBitsToFloat(texel.x), lengths.x, uintBitsToFloat(texel.w), lengths.y);
}
Layers unpackFirstLayer(uvec2 texel) { return Layers(uintBitsToFloat(texel.x), unpackHalf2x16(texel.y).y, 0.0, 0.0); }
// The normal, not normalised.
vec3 normalOf(uvec4 texel) { return directionOf(texel.y); }
vec3 normalOf(uvec2 texel) { return directionOf(vec2(int(texel.y << 24) >> 24, int(texel.y << 16) >> 24), 127.0); }

// The pixel that a texel of a level is a copy of; the level for a sample at a distance in pixels.
ivec2 pixelIn(ivec2 cell, int level, ivec2 last) { return min((cell << level) + (cell.yx & ((1 << level) - 1)), last); }
int levelFor(float pixels) { return clamp((floatBitsToInt(pixels) >> 23) - 127 - 4, 0, kDepthLevels - 1); }

uvec4 packLayers(Layers s, uint normal) {
    return uvec4(floatBitsToUint(s.first), normal, packHalf2x16(clamp(vec2(s.firstLength, s.secondLength), -kEndless, kEndless)),
        floatBitsToUint(s.second));
}
uvec2 packFirstLayer(Layers s, uint normal) {
    uint bytes = packSnorm4x8(vec4(unpackSnorm2x16(normal), 0.0, 0.0));
    return uvec2(floatBitsToUint(s.first), bytes | packHalf2x16(vec2(0.0, clamp(s.firstLength, -kEndless, kEndless))));
}

// Bits of a mask of 32 equal intervals between two places of a range, 0 to 32, rounded.
uint bitsBetween(float from, float to) {
    int first = int(from + 0.5), end = int(to + 0.5);
    return bitfieldInsert(0u, ~0u, first, max(end - first, 0));
}

#endif
