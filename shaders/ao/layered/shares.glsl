// A pixel's interleaved share: result of its slices, depth and normal, packed so that the gather reads a neighbour in one fetch.
// RG32UI, from the lowest bits on:
//     x: normal's x, signed byte; linear depth, the upper 24 bits of a float
//     y: normal's y and z, signed bytes; 6 bits: integral over the share's slices / kMostWhole; 10 bits: its blocked fraction
// One per image pixel, or per map pixel, which stands for map x map image pixels.
#ifndef OBSCURA_SHARES_GLSL
#define OBSCURA_SHARES_GLSL

const float kMostWhole = 1.575;  // at least pi/2, the integral of a slice around a grazing ray; 1 is stored as 40 of 63

uvec2 packShare(float depth, vec3 normal, float blocked, float whole) {
    uint bytes = packSnorm4x8(vec4(normal, 0.0));
    uvec2 shares = uvec2(clamp(vec2(whole / kMostWhole, blocked / max(whole, 1e-6)), 0.0, 1.0) * vec2(63.0, 1023.0) + 0.5);
    return uvec2((floatBitsToUint(depth) & ~255u) | (bytes & 255u), bytes >> 8 | shares.x << 16 | shares.y << 22);
}
float shareDepth(uvec2 share) { return uintBitsToFloat(share.x & ~255u); }
vec3 shareNormal(uvec2 share) { return vec3(int(share.x << 24) >> 24, int(share.y << 24) >> 24, int(share.y << 16) >> 24) * (1.0 / 127.0); }
// Blocked and total integral, in the same unit.
vec2 shareIntegrals(uvec2 share) {
    float whole = float(bitfieldExtract(share.y, 16, 6));
    return vec2(whole * (float(share.y >> 22) * (1.0 / 1023.0)), whole);
}

// Image pixel of a map pixel: the middle one, clamped to the image. The map's size is visible / map, rounded up.
ivec2 pixelOfMap(ivec2 cell, uint map, ivec2 visible) { return min(cell * int(map) + int(map / 2u), visible - 1); }

#endif
