// Brings together what the pixels of a tile found [Timonen 2013, sec. 10]: the mean over the side x side pixels around that lie on this
// pixel's surface. An even side has no middle: a pixel more, the outer ones counting half, keeps every share's weight and the picture
// in place.
// In: linear depth, packed normals; visibility or, with kWeighted, (w obscurance, w), taken off `open`. Out: visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/tile.glsl"
#include "shared/octahedral.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool kWeighted = false;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3) uniform sampler2D parts;
layout(set = 0, binding = 4) uniform sampler2D open;
layout(set = 0, binding = 5, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Constants { uint side; };

void main() {
    View view = viewBlock;  // a copy, so that the loop holds it in registers
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = ivec2(view.visible) - 1, guard = ivec2(view.guard);
    if (any(greaterThan(p, last))) return;
    int reach = int(side) / 2;
    float outer = (side & 1u) != 0u ? 1.0 : 0.5;
    float z = imageLoad(depth, p + guard).x;
    vec3 here = eyePosition(view, vec2(p + guard) + 0.5, z), n = unpackNormal(imageLoad(normals, p + guard).x);
    vec2 sum = vec2(0.0);
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            ivec2 at = p + ivec2(x, y), q = clamp(at, ivec2(0), last);
            vec3 there = eyePosition(view, vec2(q + guard) + 0.5, imageLoad(depth, q + guard).x);
            bool same = at == q && ofSurface(here, n, z, there, unpackNormal(imageLoad(normals, q + guard).x));
            float w = same || (x == 0 && y == 0) ? (abs(x) == reach ? outer : 1.0) * (abs(y) == reach ? outer : 1.0) : 0.0;
            vec2 part = texelFetch(parts, q, 0).xy;
            sum += w * (kWeighted ? part : vec2(part.x, 1.0));
        }
    }
    float mean = sum.x / max(sum.y, 1e-6);
    imageStore(visibility, p, vec4(clamp(kWeighted ? texelFetch(open, p, 0).x - mean : mean, 0.0, 1.0)));
}
