// Interleaving [Timonen 2013, sec. 10]: each of the n x n pixels of a tile evaluates one share of a method's directions or samples, and
// gather.comp averages neighbours on the same surface. Any n x n window contains every share once.
#ifndef OBSCURA_TILE_GLSL
#define OBSCURA_TILE_GLSL
#include "shared/view.h"

uint bayer(uvec2 p) { return ((p.x ^ p.y) & 1u) << 1 | (p.y & 1u); }
uint bayer16(uvec2 p) { return 4u * bayer(p) + bayer(p >> 1); }  // 0 to 15 over 4x4

// The pixel's share, 0 to side^2 - 1. Bayer order in 2x2 and 4x4 tiles: half a tile has every other direction. With temporal reprojection
// shares rotate over frames.
uint shareOf(View view, ivec2 pixel, uint side) {
    uvec2 p = uvec2(pixel);
    uint rank = side == 3u ? p.x % 3u + 3u * (p.y % 3u) : side == 2u ? bayer(p) : bayer16(p);
    return view.temporal != 0u ? (rank + 5u * view.frame) % (side * side) : rank;
}

// Noise in [0,1) for interleaved pixels: a lattice [Roberts 2018] whose period is not the tile's, or each share would have constant noise.
vec3 pixelNoise(ivec2 pixel) {
    return fract(float(pixel.x & 1023) * vec3(0.7548776662, 0.8191725134, 0.8566748839) +
                 float(pixel.y & 1023) * vec3(0.5698402910, 0.6710436067, 0.7338918566));
}

// Whether `there`, with normal m, is on the surface through `here`, with normal n. depth: that of `here`, depthForTolerance().
bool ofSurface(vec3 here, vec3 n, float depth, vec3 there, vec3 m) {
    return dot(n, m) > 0.5 && abs(dot(there - here, n)) < 0.01 * depth;
}

#endif
