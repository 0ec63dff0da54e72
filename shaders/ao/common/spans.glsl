// What is solid along a texel's view ray: one or two spans of matter, from depth layers (obscura/ao.h, DepthLayers), in one texel with
// depth and normal. spans.comp writes it, runtime/ao/spans.h says when.
// Two spans, RGBA32UI:
//     x: linear depth, bits of a float; y: packed normal; z: halves, length of the first span and of the second, metres along the
//     camera's axis; w: linear depth of the second, bits of a float, 0: there is none
// One span, RG32UI:
//     x: linear depth, bits of a float; y: octahedral normal in two signed bytes, above it the half of the length
// A negative length says that the distance to the span is that to its front: it is a sheet, or endless. To what is
// solid, length above 0, the distance is that to its nearest point: what stands behind it sees its back.
// Coarser levels lie beside it, as depth_mips.glsl says: a texel of level n is one of the 2^n x 2^n pixels under it, whole, another in
// every row and column, so that nothing is mixed and nothing thin is missed by all. Samples far away find theirs in fewer cache lines.
#ifndef OBSCURA_SPANS_GLSL
#define OBSCURA_SPANS_GLSL
#include "ao/common/depth_mips.glsl"
#include "shared/octahedral.glsl"

const float kEndless = 65504.0;  // a length without end

struct Spans {
    float first, firstLength;    // [first, first + |firstLength|]
    float second, secondLength;  // likewise, where second > 0
};
Spans unpackSpans(uvec4 texel) {
    vec2 lengths = unpackHalf2x16(texel.z);
    return Spans(uintBitsToFloat(texel.x), lengths.x, uintBitsToFloat(texel.w), lengths.y);
}
Spans unpackSpan(uvec2 texel) { return Spans(uintBitsToFloat(texel.x), unpackHalf2x16(texel.y).y, 0.0, 0.0); }
// Towards the normal, of any length.
vec3 normalOf(uvec4 texel) { return directionOf(texel.y); }
vec3 normalOf(uvec2 texel) { return directionOf(vec2(int(texel.y << 24) >> 24, int(texel.y << 16) >> 24), 127.0); }

// The pixel that a coarser level's texel holds, and the level for a sample so many pixels away.
ivec2 pixelIn(ivec2 cell, int level, ivec2 last) { return min((cell << level) + (cell.yx & ((1 << level) - 1)), last); }
int levelFor(float pixels) { return clamp((floatBitsToInt(pixels) >> 23) - 127 - 4, 0, kDepthLevels - 1); }

uvec4 packSpans(Spans s, uint normal) {
    return uvec4(floatBitsToUint(s.first), normal, packHalf2x16(clamp(vec2(s.firstLength, s.secondLength), -kEndless, kEndless)), floatBitsToUint(s.second));
}
uvec2 packSpan(Spans s, uint normal) {
    uint bytes = packSnorm4x8(vec4(unpackSnorm2x16(normal), 0.0, 0.0));
    return uvec2(floatBitsToUint(s.first), bytes | packHalf2x16(vec2(0.0, clamp(s.firstLength, -kEndless, kEndless))));
}

// Thirty-two equal parts of a range, those between two places of it, 0 to 32: to take each for blocked but once.
uint partsBetween(float from, float to) {
    int first = int(from + 0.5), end = int(to + 0.5);
    return bitfieldInsert(0u, ~0u, first, max(end - first, 0));
}

#endif
