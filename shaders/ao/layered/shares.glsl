// A pixel's interleaved share, packed so that the gather reads a neighbour in one fetch. RG32UI: x: linear depth, metres; y, two halves:
// the blocked part of the integral over the share's slices, and the whole integral.
// One per image pixel, or per map pixel, which stands for map x map image pixels.
#ifndef OBSCURA_SHARES_GLSL
#define OBSCURA_SHARES_GLSL

uvec4 packShare(float depth, float blocked, float whole) {
    return uvec4(floatBitsToUint(depth), packHalf2x16(vec2(blocked, whole)), 0u, 0u);
}
float shareDepth(uvec2 share) { return uintBitsToFloat(share.x); }
vec2 shareIntegrals(uvec2 share) { return unpackHalf2x16(share.y); }  // blocked, whole

// Image pixel of a map pixel: the middle one, clamped to the image. The map's size is visible / map, rounded up.
ivec2 pixelOfMap(ivec2 cell, uint map, ivec2 visible) { return min(cell * int(map) + int(map / 2u), visible - 1); }

#endif
