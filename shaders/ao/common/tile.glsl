// Interleaving [Timonen 2013, sec. 10]: the n x n pixels of a tile share out a method's directions or samples, and gather.comp brings
// together what the neighbours of one surface found. Any n x n pixels hold every share once, wherever they begin.
#ifndef OBSCURA_TILE_GLSL
#define OBSCURA_TILE_GLSL
#include "shared/view.h"

uint bayer(uvec2 p) { return ((p.x ^ p.y) & 1u) << 1 | (p.y & 1u); }
uint bayer16(uvec2 p) { return 4u * bayer(p) + bayer(p >> 1); }  // 0 to 15 over 4x4

// Which of the side^2 shares is this pixel's. Bayer's order in 2x2 and 4x4: half a tile holds every other direction. Where a history
// averages over frames, shares go around.
uint shareOf(View view, ivec2 pixel, uint side) {
    uvec2 p = uvec2(pixel);
    uint rank = side == 3u ? p.x % 3u + 3u * (p.y % 3u) : side == 2u ? bayer(p) : bayer16(p);
    return view.temporal != 0u ? (rank + 5u * view.frame) % (side * side) : rank;
}

// Noise in [0,1) for pixels that share: a lattice [Roberts 2018] whose period is no tile's, or a direction would always have the same.
vec3 pixelNoise(ivec2 pixel) {
    return fract(float(pixel.x & 1023) * vec3(0.7548776662, 0.8191725134, 0.8566748839) + float(pixel.y & 1023) * vec3(0.5698402910, 0.6710436067, 0.7338918566));
}

// Is `there`, with normal m, of the surface through `here`, seen at depth z, with normal n?
bool ofSurface(vec3 here, vec3 n, float z, vec3 there, vec3 m) { return dot(n, m) > 0.5 && abs(dot(there - here, n)) < 0.01 * z; }

#endif
