// Box average: depth and normal of the 3x3 neighbours that lie on the same surface, and which ones those are [Timonen 2013, sec. 10]. Each of
// them evaluates other sectors, from this average instead of its own position, so that their parts fit together.
// In: linear depth, packed normals. Out: packed normal and depth; the depth's lowest nine bits say who was accepted.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, rg32ui) uniform writeonly uimage2D surfaces;

const float kLeastCosine = 0.5, kMostDepth = 0.03;  // relative

void main() {
    View view = viewBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 guard = ivec2(view.guard);
    float here = imageLoad(depth, p + guard).x, depths = 0.0, accepted = 0.0;
    vec3 n = unpackNormal(imageLoad(normals, p + guard).x), sum = vec3(0.0);
    uint mask = 0u;
    for (int i = 0; i < 9; ++i) {
        ivec2 q = p + ivec2(i % 3 - 1, i / 3 - 1);
        bool inside = all(greaterThanEqual(q, ivec2(0))) && all(lessThan(q, ivec2(view.visible)));
        q = (inside ? q : p) + guard;
        float z = imageLoad(depth, q).x;
        vec3 m = unpackNormal(imageLoad(normals, q).x);
        bool same = i == 4 || (inside && dot(n, m) > kLeastCosine && abs(z - here) < kMostDepth * here);
        depths += same ? z : 0.0;
        sum += same ? m : vec3(0.0);
        accepted += same ? 1.0 : 0.0;
        mask |= same ? 1u << i : 0u;
    }
    uint bits = floatBitsToUint(isSky(view, here) ? here : depths / accepted) & ~511u;
    imageStore(surfaces, p, uvec4(packNormal(normalize(sum)), bits | mask, 0, 0));
}
