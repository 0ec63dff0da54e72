// Lookups in the volume: occupied cells of the world around the camera, as levels of dense, world-anchored cubes of bits. Level 0 has the
// smallest cells; a cell of level k + 1 is the union of eight cells of level k and set if any of them is. All cubes have the same number of
// cells and the same middle, so the cube of level k is 2^k times as wide as that of level 0.
// A brick has 8 cells a side and 16 words: bit 8 (y & 3) + (z & 7) of word 2 (x & 7) + ((y & 7) >> 2). Bricks are in the order
// ((x >> 3) s + (y >> 3)) s + (z >> 3), s bricks a side. Coordinates are modulo the side, so moving a cube rewrites only the cells that
// enter. Levels follow one another.
#ifndef OBSCURA_SHARED_VOLUME_H
#define OBSCURA_SHARED_VOLUME_H
#include "types.h"
OBSCURA_SHARED_BEGIN

struct Volume {      // places are in cells of level 0, counted from `anchor`
    vec4 rows[3];    // (eye-space point, 1) -> place
    uvec4 anchor;    // xyz: that cell of the world, signed, a multiple of 2^(levels - 1); w: cells a side, a power of two; 0: a NanoVDB
                     // grid without an edge
    vec4 centre;     // xyz: the place in the middle of all levels; w: metres per cell of level 0
    float halfSide;  // a level holds all its cells less than so many of them from the middle, along each axis
    float fade;      // hits lose their weight at the edge of the last level, by so much per cell of level 0
    uint levels;
    uint unused;
};
OBSCURA_SHARED_SIZE(Volume, 96);

OBSCURA_SHARED_END

#ifndef __cplusplus
vec3 cellOf(Volume v, vec3 eye) { return vec3(dot(v.rows[0], vec4(eye, 1)), dot(v.rows[1], vec4(eye, 1)), dot(v.rows[2], vec4(eye, 1))); }
// An eye-space direction in cells of level 0 per metre.
vec3 cellsAlong(Volume v, vec3 d) { return vec3(dot(v.rows[0].xyz, d), dot(v.rows[1].xyz, d), dot(v.rows[2].xyz, d)); }
// The inverse: the eye-space direction of a unit vector in cell axes.
vec3 eyeAlong(Volume v, vec3 d) { return (v.rows[0].xyz * d.x + v.rows[1].xyz * d.y + v.rows[2].xyz * d.z) * v.centre.w; }

// Distance from the middle along the axis where it is largest, cells of level 0.
float farFromMiddle(Volume v, vec3 place) {
    vec3 d = abs(place - v.centre.xyz);
    return max(max(d.x, d.y), d.z);
}
// The smallest k >= 0 with x < 2^k.
uint ceilLog2(float x) { return (floatBitsToUint(max(x, 0.5)) >> 23) - 126u; }
// The finest level that holds places `far` cells from the middle; may be v.levels or more: none does.
uint levelWithin(Volume v, float far) { return ceilLog2(far / v.halfSide); }
// Weight of a hit: 0 outside of the last level, 1 inside but for the last eighth of its width if there is more than one level.
float hitWeight(Volume v, vec3 place) {
    return clamp((ldexp(v.halfSide, int(v.levels) - 1) - farFromMiddle(v, place)) * v.fade, 0.0, 1.0);
}

// Word and bit of a cell of a level, modulo the side.
uint wordOf(Volume v, uvec3 cell, uint level) {
    uvec3 p = (cell + (v.anchor.xyz >> level)) & (v.anchor.w - 1u);
    uvec3 brick = p >> 3;
    uint side = uint(findMSB(v.anchor.w)) - 3u;  // its binary logarithm, in bricks
    return (((level << side | brick.x) << side | brick.y) << side | brick.z) << 4 | (p.x & 7u) << 1 | (p.y >> 2 & 1u);
}
uint bitOf(Volume v, uvec3 cell, uint level) {
    uvec2 p = cell.yz + (v.anchor.yz >> level);
    return ((p.x & 3u) << 3) | (p.y & 7u);
}

// A shader that reads cells defines VOLUME_BINDING, the binding of the bits in set 0, before including this, and calls openVolume() before
// the first lookup. With VOLUME_NANOVDB the same functions read a NanoVDB grid of type mask: one without an edge (`anchor.w` is 0, one
// level), or one that holds cell (x, y, z) of level k at (k s + x, y, z) modulo s, s cells a side.
#ifdef VOLUME_BINDING
#ifdef VOLUME_NANOVDB
#include "shared/volume_nanovdb.h"
#else
layout(set = 0, binding = VOLUME_BINDING, std430) readonly buffer VolumeBits { uint volumeBits[]; };
void openVolume() {}
// Whether a cell of a level is set. `place`: in cells of that level, which must hold it.
bool occupiedAt(Volume v, vec3 place, uint level) {
    uvec3 cell = uvec3(ivec3(place));
    return (volumeBits[wordOf(v, cell, level)] >> bitOf(v, cell, level) & 1u) != 0u;
}
// Side of the largest known empty cube around the place in a level, in its cells; 0 in a set cell.
float emptySideAt(Volume v, vec3 place, uint level) {
    if (occupiedAt(v, place, level)) return 0.0;
    uint word = wordOf(v, uvec3(ivec3(place)), level) & ~15u, any = 0u;
    for (uint i = 0u; i < 16u; ++i) any |= volumeBits[word + i];
    return any == 0u ? 8.0 : 1.0;
}
#endif

// Whether a place is in a set cell of the finest level that holds it.
bool occupied(Volume v, vec3 place) {
    uint level = levelWithin(v, farFromMiddle(v, place));
    return level < v.levels && occupiedAt(v, ldexp(place, ivec3(-int(level))), level);
}
// For traversal: emptySide() is 0 in a set cell, else the side of the largest known empty cube around the place, in cells of level 0;
// cubeBegin() is that cube's lowest corner. A level must hold the place.
float emptySide(Volume v, vec3 place) {
    uint level = levelWithin(v, farFromMiddle(v, place));
    return ldexp(emptySideAt(v, ldexp(place, ivec3(-int(level))), level), int(level));
}
vec3 cubeBegin(Volume v, vec3 place, float side) {
    ivec3 corner = ivec3(v.anchor.xyz);  // cubes begin at multiples of their side in the world
    return vec3(((ivec3(floor(place)) + corner) & ~(ivec3(side) - 1)) - corner);
}
#endif
#endif

#endif
