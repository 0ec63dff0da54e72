// What a pixel's share of the slices found, with what tells its surface from others: all that a neighbour's gather reads, in one fetch.
// RG32UI, from the lowest bits on:
//     x: normal's x, signed byte; linear depth, the upper 24 bits of a float
//     y: normal's y and z, signed bytes; 6 bits: the part of the integral that these slices hold, over kMostWhole; 10 bits: how much of
//     that is blocked
// Of every pixel of the picture, or of a map: then each stands for map x map of them.
#ifndef OBSCURA_PARTS_GLSL
#define OBSCURA_PARTS_GLSL

const float kMostWhole = 1.575;  // at least pi/2, a slice around a ray that grazes the surface; 1 is 40 of 63 parts

uvec2 packPart(float depth, vec3 normal, float blocked, float whole) {
    uint bytes = packSnorm4x8(vec4(normal, 0.0));
    uvec2 parts = uvec2(clamp(vec2(whole / kMostWhole, blocked / max(whole, 1e-6)), 0.0, 1.0) * vec2(63.0, 1023.0) + 0.5);
    return uvec2((floatBitsToUint(depth) & ~255u) | (bytes & 255u), bytes >> 8 | parts.x << 16 | parts.y << 22);
}
float partDepth(uvec2 part) { return uintBitsToFloat(part.x & ~255u); }
vec3 partNormal(uvec2 part) { return vec3(int(part.x << 24) >> 24, int(part.y << 24) >> 24, int(part.y << 16) >> 24) * (1.0 / 127.0); }
// Blocked and whole, in one unit.
vec2 partShares(uvec2 part) {
    float whole = float(bitfieldExtract(part.y, 16, 6));
    return vec2(whole * (float(part.y >> 22) * (1.0 / 1023.0)), whole);
}

// Which pixel one of a map's stands for: the middle one, or the last there is. A map's size is the visible one over this, rounded up.
ivec2 pixelOfMap(ivec2 cell, uint map, ivec2 visible) { return min(cell * int(map) + int(map / 2u), visible - 1); }

#endif
