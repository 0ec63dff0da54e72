// Box average of depth and normal over the neighbours on the same surface [Timonen 2013, sec. 10]. Interleaved pixels evaluate different
// sectors from this average instead of their own position, so that their shares are consistent. The window is gather.glsl's.
// In: linear depth, packed normals. Out: packed normal and depth.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/tile.glsl"
#include "ao/far_field/constants.h"
#include "ao/far_field/similar.glsl"
#include "shared/octahedral.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool kSimilar = false;  // neighbours by similar(), else by ofSurface()
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, rg32ui) uniform writeonly uimage2D surfaces;
layout(push_constant) uniform Block { FarFieldBoxAverage constants; };

void main() {
    View view = viewBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = ivec2(view.visible) - 1, guard = ivec2(view.guard);
    if (any(greaterThan(p, last))) return;
    int reach = int(constants.side) / 2;
    float outer = (constants.side & 1u) != 0u ? 1.0 : 0.5;
    float z = imageLoad(depth, p + guard).x, scale = depthForTolerance(view, z), depths = 0.0, weights = 0.0;
    vec3 here = eyePosition(view, vec2(p + guard) + 0.5, z), n = unpackNormal(imageLoad(normals, p + guard).x), sum = vec3(0.0);
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            ivec2 at = p + ivec2(x, y), q = clamp(at, ivec2(0), last) + guard;
            float zq = imageLoad(depth, q).x;
            vec3 m = unpackNormal(imageLoad(normals, q).x);
            vec3 there = eyePosition(view, vec2(q) + 0.5, zq);
            bool same = at + guard == q && (kSimilar ? similar(here, n, scale, there, m) : ofSurface(here, n, scale, there, m));
            float w = same || (x == 0 && y == 0) ? (abs(x) == reach ? outer : 1.0) * (abs(y) == reach ? outer : 1.0) : 0.0;
            depths += w * zq;
            sum += w * m;
            weights += w;
        }
    }
    imageStore(surfaces, p, uvec4(packNormal(normalize(sum)), floatBitsToUint(isSky(view, z) ? z : depths / weights), 0, 0));
}
