// Lookups in the volume: occupied cells of the world around the camera, as a dense, world-anchored cube of bits. A brick has 8 cells a side
// and 16 words: bit 8 (y & 3) + (z & 7) of word 2 (x & 7) + ((y & 7) >> 2). Bricks are in the order ((x >> 3) s + (y >> 3)) s + (z >> 3), s
// bricks a side. Coordinates are modulo the side, so moving the window rewrites only the cells that enter.
#ifndef OBSCURA_SHARED_VOLUME_H
#define OBSCURA_SHARED_VOLUME_H
#include "types.h"
OBSCURA_SHARED_BEGIN

struct Volume {
    vec4 rows[3];  // (eye-space point, 1) -> cells from the window's lowest corner
    uvec4 shift;   // xyz: the lowest cell modulo the side; w: cells a side, a power of two; 0: a NanoVDB grid, see below
    vec4 anchor;   // w: metres per cell; the rest is 0
};
OBSCURA_SHARED_SIZE(Volume, 80);

OBSCURA_SHARED_END

#ifndef __cplusplus
vec3 cellOf(Volume v, vec3 eye) { return vec3(dot(v.rows[0], vec4(eye, 1)), dot(v.rows[1], vec4(eye, 1)), dot(v.rows[2], vec4(eye, 1))); }
// An eye-space direction in cells per metre.
vec3 cellsAlong(Volume v, vec3 d) { return vec3(dot(v.rows[0].xyz, d), dot(v.rows[1].xyz, d), dot(v.rows[2].xyz, d)); }
// The inverse: the eye-space direction of a unit vector in cell axes.
vec3 eyeAlong(Volume v, vec3 d) { return (v.rows[0].xyz * d.x + v.rows[1].xyz * d.y + v.rows[2].xyz * d.z) * v.anchor.w; }
// Word and bit of a cell. Coordinates wrap: check insideVolume() first.
uint wordOf(Volume v, uvec3 cell) {
    uvec3 p = (cell + v.shift.xyz) & (v.shift.w - 1u);
    uvec3 brick = p >> 3;
    uint side = v.shift.w >> 3;
    return ((((brick.x * side + brick.y) * side + brick.z) << 4) | ((p.x & 7u) << 1) | ((p.y >> 2) & 1u));
}
uint bitOf(Volume v, uvec3 cell) {
    uvec2 p = cell.yz + v.shift.yz;
    return ((p.x & 3u) << 3) | (p.y & 7u);
}
bool insideVolume(Volume v, vec3 cell) {
    return min(min(cell.x, cell.y), cell.z) >= 0.0 && max(max(cell.x, cell.y), cell.z) < float(v.shift.w);
}

// A shader that reads cells defines VOLUME_BINDING, the binding of the bits in set 0, before including this, and calls openVolume() before
// the first lookup. With VOLUME_NANOVDB the same functions read a NanoVDB grid; `shift` is then a cell near the eye, and w is 0.
#ifdef VOLUME_BINDING
#ifdef VOLUME_NANOVDB
#include "shared/volume_nanovdb.h"
#else
layout(set = 0, binding = VOLUME_BINDING, std430) readonly buffer VolumeBits { uint volumeBits[]; };
// Whether a place, in cells from the window's lowest corner, is in a set cell.
bool occupied(Volume v, vec3 place) {
    uvec3 cell = uvec3(ivec3(place));
    return (volumeBits[wordOf(v, cell)] >> bitOf(v, cell) & 1u) != 0u && insideVolume(v, place);
}
void openVolume() {}

// For traversal: emptySide() is 0 in a set cell, else the side of the largest known empty cube around the place; cubeBegin() is that
// cube's lowest corner. The place must be inside volumeBox().
float emptySide(Volume v, vec3 place) {
    if (occupied(v, place)) return 0.0;
    uint word = wordOf(v, uvec3(ivec3(place))) & ~15u, any = 0u;
    for (uint i = 0u; i < 16u; ++i) any |= volumeBits[word + i];
    return any == 0u ? 8.0 : 1.0;
}
vec3 cubeBegin(Volume v, vec3 place, float side) { return floor(place / side) * side; }
void volumeBox(Volume v, out vec3 low, out vec3 high) {
    low = vec3(0.0);
    high = vec3(float(v.shift.w));
}
#endif
#endif
#endif

#endif
