// What is solid along a texel's view ray: up to two spans of matter, from depth layers (obscura/ao.h, DepthLayers), in one texel with
// depth and normal. spans.comp writes it, runtime/ao/spans.h says when.
//     x: linear depth, bits of a float; y: packed normal; z: halves, length of the first span and of the second, metres along the
//     camera's axis; w: linear depth of the second, bits of a float, 0: there is none
// A negative length says that the distance to the span is that to its front: it is a sheet, or endless, or only assumed. To what is
// solid, length above 0, the distance is that to its nearest point: what stands behind it sees its back.
#ifndef OBSCURA_SPANS_GLSL
#define OBSCURA_SPANS_GLSL

const float kEndless = 65504.0;  // a length without end

struct Spans {
    float first, firstLength;    // [first, first + |firstLength|]
    float second, secondLength;  // likewise, where second > 0
};
Spans unpackSpans(uvec4 texel) {
    vec2 lengths = unpackHalf2x16(texel.z);
    return Spans(uintBitsToFloat(texel.x), lengths.x, uintBitsToFloat(texel.w), lengths.y);
}
uvec4 packSpans(Spans s, uint normal) {
    return uvec4(floatBitsToUint(s.first), normal, packHalf2x16(clamp(vec2(s.firstLength, s.secondLength), -kEndless, kEndless)), floatBitsToUint(s.second));
}

// Thirty-two equal parts of a range, those between two places of it, 0 to 32: to take each for blocked but once.
uint partsBetween(float from, float to) {
    int first = int(from + 0.5), end = int(to + 0.5);
    return bitfieldInsert(0u, ~0u, first, max(end - first, 0));
}

#endif
