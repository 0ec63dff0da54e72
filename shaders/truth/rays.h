// The rays of both references, with the same numbers in C++ and GLSL. Ray k of a receiver is point k / 16 of the Owen-scrambled Sobol
// sequence k % 16. The sequences are scrambled independently, so the scatter of their means estimates the error of the mean [Owen 1995;
// L'Ecuyer and Lemieux 2002].
#ifndef OBSCURA_TRUTH_RAYS_H
#define OBSCURA_TRUTH_RAYS_H
#include "shared/types.h"

#ifdef __cplusplus
#define OBSCURA_RAYS_FUNCTION inline
#else
#define OBSCURA_RAYS_FUNCTION
#endif

OBSCURA_SHARED_BEGIN

struct MarchReceiver {
    vec4 position;  // eye space, offset from the surface, m; w unused
    vec4 normal;    // eye space, unit; w: bits of the receiver's seed
};
OBSCURA_SHARED_SIZE(MarchReceiver, 32);

struct MarchConstants {
    uint receivers;
    uint firstPoint;     // of every sequence
    uint points;         // of every sequence, in this dispatch
    uint falloffs;
    float rayLength;     // m
    float thickness;     // m along the view axis; huge: infinite
    float near;          // m; a ray nearer to the camera's plane has escaped
    float tolerance;     // m at a depth of 1 m (orthographic: m) that a ray must be behind a texel to be blocked
    uint tableSize;      // samples of each falloff
    uint unused[3];
};
OBSCURA_SHARED_SIZE(MarchConstants, 48);

#ifdef __cplusplus
inline uint bitfieldReverse(uint x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}
#endif

const uint kSequences = 16u;

// A bijective mixer of 32 bits with low bias [Wellons 2018, lowbias32].
OBSCURA_RAYS_FUNCTION uint mixBits(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

OBSCURA_RAYS_FUNCTION uint receiverSeed(uint seed, uint index) { return mixBits(mixBits(seed) ^ (index + 0x9e3779b9u)); }

// Nested uniform scramble of the reversed bits [Laine and Karras 2011, constants of Vegdahl 2021].
OBSCURA_RAYS_FUNCTION uint scrambleReversed(uint x, uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

OBSCURA_RAYS_FUNCTION float unitFloat(uint x) { return float(x >> 8) * (1.0f / 16777216.0f); }

// First and second Sobol dimension, scrambled.
OBSCURA_RAYS_FUNCTION float rayU(uint point, uint sequence, uint seed) {
    return unitFloat(bitfieldReverse(scrambleReversed(point, mixBits(seed + 2u * sequence))));
}

OBSCURA_RAYS_FUNCTION float rayV(uint point, uint sequence, uint seed) {
    uint bits = 0u;
    uint direction = 0x80000000u;
    for (uint i = point; i != 0u; i >>= 1) {
        if ((i & 1u) != 0u) bits ^= direction;
        direction ^= direction >> 1;
    }
    return unitFloat(bitfieldReverse(scrambleReversed(bitfieldReverse(bits), mixBits(seed + 2u * sequence + 1u))));
}

OBSCURA_SHARED_END

#ifndef __cplusplus
// Cosine-distributed about n [basis: Duff 2017].
vec3 rayDirection(vec3 n, float u, float v) {
    float r = sqrt(u), phi = 6.28318531 * v;
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z), b = n.x * n.y * a;
    vec3 x = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    vec3 y = vec3(b, s + n.y * n.y * a, -n.y);
    return normalize(x * (r * cos(phi)) + y * (r * sin(phi)) + n * sqrt(max(1.0 - u, 0.0)));
}
#endif

#endif
