// Brings together what the pixels of a tile found: the side x side pixels around, their outer rows counting half where the side is even,
// so that each share of the slices weighs the same and no tile shows. Neighbours count by how well they lie on this pixel's surface;
// what is averaged is what was blocked and what could have been: where an edge leaves some shares out, slices that hold more of the
// hemisphere than others do not tip the scale.
// In: linear depth, packed normals; (blocked, whole) of each pixel's slices. Out: visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, rg16f) uniform readonly image2D parts;
layout(set = 0, binding = 4, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Constants { uint side; };

const float kPlane = 1000.0;  // per plane distance over depth: half the weight a thousandth of the depth off the surface

void main() {
    View view = viewBlock;  // a copy, so that the loop holds it in registers
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = ivec2(view.visible) - 1, guard = ivec2(view.guard);
    if (any(greaterThan(p, last))) return;
    float z = imageLoad(depth, p + guard).x;
    if (isSky(view, z)) {
        imageStore(visibility, p, vec4(1.0));
        return;
    }
    // A neighbour's distance to this pixel's tangent plane, told in pixels and depth: none of them needs its position.
    bool orthographic = view.orthographic > 0.5;
    vec3 n = unpackNormal(imageLoad(normals, p + guard).x);
    vec2 slope = n.xy * view.unproject.xy;
    float aside = dot((vec2(p + guard) + 0.5), slope) + dot(n.xy, view.unproject.zw), plane = aside * (orthographic ? 1.0 : z) - n.z * z;
    int reach = int(side) / 2;
    float outer = (side & 1u) != 0u ? 1.0 : 0.5, sharpness = kPlane / z;
    vec2 sum = vec2(0.0);
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            ivec2 at = p + ivec2(x, y), q = clamp(at, ivec2(0), last);
            float there = imageLoad(depth, q + guard).x;
            float off = (aside + dot(vec2(x, y), slope)) * (orthographic ? 1.0 : there) - n.z * there - plane;
            // facing^4 / (1 + sharpness off), the normal of no unit length
            vec3 m = directionOf(imageLoad(normals, q + guard).x);
            float facing = max(0.0, dot(n, m)), square = dot(m, m);
            facing *= facing;
            float rim = (abs(x) == reach ? outer : 1.0) * (abs(y) == reach ? outer : 1.0);
            float w = at == q ? rim * facing * facing / (square * square * (1.0 + sharpness * abs(off))) : 0.0;
            sum += (x == 0 && y == 0 ? 1.0 : w) * imageLoad(parts, q).xy;
        }
    }
    imageStore(visibility, p, vec4(clamp(1.0 - sum.x / max(sum.y, 1e-6), 0.0, 1.0)));
}
