// Shared by passes that trace the volume on a map of fewer pixels than the image (runtime/ao/upsample.h): bindings, choice of the receiver,
// noise fixed in the world, a basis around a normal. The includer defines VOLUME_BINDING 2 (shared/volume.h).
// In: view, volume, linear depth, packed normals. Out: visibility and depth and normal of the map's receivers.
#ifndef OBSCURA_MAP_GLSL
#define OBSCURA_MAP_GLSL
#include "shared/octahedral.glsl"
#include "shared/view.h"
#include "shared/volume.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, std140) uniform VolumeBlock { Volume volumeBlock; };
layout(set = 0, binding = 3, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 4, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 5, r16f) uniform writeonly image2D map;
layout(set = 0, binding = 6, rg32ui) uniform writeonly uimage2D receivers;  // linear depth as bits, packed normal

// Receiver of map pixel p: of its `every` x `every` image pixels, the one whose normal is closest to their mean, so that features one pixel
// wide are not picked at random. Result in buffer pixels, guard band included.
ivec2 receiverOf(View view, ivec2 p, int every) {
    ivec2 corner = p * every + ivec2(view.guard), last = ivec2(view.visible) - 1 + ivec2(view.guard);
    vec3 normalSum = vec3(0.0);
    for (int i = 0; i < every * every; ++i) {
        ivec2 q = min(corner + ivec2(i % every, i / every), last);
        normalSum += isSky(view, imageLoad(depth, q).x) ? vec3(0.0) : unpackNormal(imageLoad(normals, q).x);
    }
    float best = -1e9;
    ivec2 texel = corner;
    for (int i = 0; i < every * every; ++i) {
        ivec2 q = min(corner + ivec2(i % every, i / every), last);
        float agreement = isSky(view, imageLoad(depth, q).x) ? -1e8 : dot(normalSum, unpackNormal(imageLoad(normals, q).x));
        texel = agreement > best + 1e-4 ? q : texel;
        best = max(best, agreement);
    }
    return texel;
}

// Stores the receiver of map pixel p. Out: its position and its normal towards the eye. False: sky; visibility 1 is stored.
bool receive(View view, ivec2 p, int every, out vec3 here, out vec3 n) {
    ivec2 texel = receiverOf(view, p, every);
    float z = imageLoad(depth, texel).x;
    uint packed = imageLoad(normals, texel).x;
    imageStore(receivers, p, uvec4(floatBitsToUint(z), packed, 0, 0));
    here = eyePosition(view, vec2(texel) + 0.5, z);
    n = unpackNormal(packed);
    n = dot(n, towardsEye(view, here)) < 0.0 ? -n : n;
    if (isSky(view, z)) imageStore(map, p, vec4(1.0));
    return !isSky(view, z);
}

// Cell of a world-fixed lattice that contains a surface point; a lattice cell has 1.25 x 2^size volume cells a side, so that both do not
// repeat together. The point is offset along the normal, because floors and walls are often on cell boundaries, where rounding would make
// noise flicker. The anchor is added in integers, which keeps precision far from the world's origin.
const float kOffSurface = 0.31, kLatticeSide = 1.25, kLatticePeriod = 1024.0;
ivec3 latticeCell(Volume v, vec3 place, vec3 normal, uint size) {
    vec3 inWorld = mod(place + vec3(v.anchor.xyz & 1023u), kLatticePeriod);
    return ivec3(ldexp(inWorld, ivec3(-int(size))) / kLatticeSide + kOffSurface * normal);
}
// The size of lattice cells at a receiver: cells of its level, and never below `pixels` px of the image, where noise would flicker.
uint latticeSize(View view, Volume v, uint level, vec3 here, float pixels) {
    float footprint = (view.orthographic > 0.5 ? 1.0 : -here.z) / view.pixelsPerMetre;
    return min(max(level, ceilLog2(0.5 * pixels * footprint / v.centre.w)), 10u);
}

// Three numbers in [0,1) from a lattice cell [Jarzynski and Olano 2020, pcg3d].
vec3 cellNoise(ivec3 cell) {
    uvec3 v = uvec3(cell) * 1664525u + 1013904223u;
    v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
    return vec3(v >> 8) / 16777216.0;
}

// Two unit vectors across a unit vector [Duff 2017, Building an Orthonormal Basis, Revisited].
void basisAround(vec3 n, out vec3 tangent, out vec3 bitangent) {
    float s = n.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (s + n.z), b = n.x * n.y * a;
    tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    bitangent = vec3(b, s + n.y * n.y * a, -n.y);
}

#endif
