// What passes share that trace the volume on a map with fewer pixels than the picture (runtime/ao/upsample.h): bindings, which pixel
// receives, noise that rests on surfaces, a frame around a normal. The includer says VOLUME_BINDING 2 (shared/volume.h).
// In: view, volume, linear depth, packed normals. Out: visibility of the map's receivers, and what they are.
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

// Of the `every` x `every` pixels that the map's pixel p stands for, the one that faces most as all of them do, guard band counted:
// a ledge a pixel wide is not sampled by chance, here and there.
ivec2 receiverOf(View view, ivec2 p, int every) {
    ivec2 corner = p * every + ivec2(view.guard), last = ivec2(view.visible) - 1 + ivec2(view.guard);
    vec3 together = vec3(0.0);
    for (int i = 0; i < every * every; ++i) {
        ivec2 q = min(corner + ivec2(i % every, i / every), last);
        together += isSky(view, imageLoad(depth, q).x) ? vec3(0.0) : unpackNormal(imageLoad(normals, q).x);
    }
    float best = -1e9;
    ivec2 texel = corner;
    for (int i = 0; i < every * every; ++i) {
        ivec2 q = min(corner + ivec2(i % every, i / every), last);
        float agrees = isSky(view, imageLoad(depth, q).x) ? -1e8 : dot(together, unpackNormal(imageLoad(normals, q).x));
        texel = agrees > best + 1e-4 ? q : texel;
        best = max(best, agrees);
    }
    return texel;
}

// Notes the receiver of the map's pixel p: where it is and its normal, towards the eye. False: it is sky, and open.
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

// Which cell of a lattice that rests in the world a place on a surface lies in, the lattice's `grain` cells of the volume a side. Looked up a
// little off the surface: floors and walls like to stand where cells meet, and there rounding would shuffle noise. What lies far from the
// world's origin is counted in integers.
const float kOffSurface = 0.31;  // cells
ivec3 latticeCell(Volume v, vec3 place, vec3 normal, float grain) {
    float side = v.shift.w == 0u ? 1024.0 : float(v.shift.w);
    return ivec3(mod(place + kOffSurface * normal + vec3(v.shift.xyz & 1023u), side) / grain);
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
void around(vec3 n, out vec3 tangent, out vec3 bitangent) {
    float s = n.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (s + n.z), b = n.x * n.y * a;
    tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    bitangent = vec3(b, s + n.y * n.y * a, -n.y);
}

#endif
