// Gather of interleaved shares over side x side neighbours. For an even side the window is one pixel wider and its outer rows have half
// weight, so that all shares weigh the same and no tile pattern is left. Neighbours are weighted by how closely they are on this pixel's
// surface. Blocked and total integrals are averaged separately, so that an edge that excludes some slices adds no bias. With a map, map
// pixels gather first; image pixels then gather from the four map pixels around them.
// In: linear depth, packed normals; shares of the image's or the map's pixels. Out: visibility, or with TO_MAP gathered shares.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant TO_MAP
#include "ao/layered/constants.h"
#include "ao/layered/shares.glsl"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, rg32ui) uniform readonly uimage2D shares;
#ifdef TO_MAP
layout(set = 0, binding = 4, rg32ui) uniform writeonly uimage2D gathered;
#else
layout(set = 0, binding = 4, r16f) uniform writeonly image2D visibility;
#endif
layout(push_constant) uniform Block { LayeredGather constants; };

const float kAcross = 0.03;   // least cosine between normals, so that surfaces missing in the map still get a value
const float kPlane = 1000.0;  // per plane distance / depth: half the weight at a thousandth of the depth

void main() {
    View view = viewBlock;  // a copy, so that the loop holds it in registers
    ivec2 here = ivec2(gl_GlobalInvocationID.xy), visible = ivec2(view.visible), last = imageSize(shares) - 1, guard = ivec2(view.guard);
#ifdef TO_MAP
    if (any(greaterThan(here, last))) return;
    ivec2 p = pixelOfMap(here, constants.map, visible);
    vec2 place = vec2(here);
#else
    if (any(greaterThanEqual(here, visible))) return;
    ivec2 p = here;
    vec2 place = (vec2(p) - float(constants.map / 2u)) / float(constants.map);
#endif
    float z = imageLoad(depth, p + guard).x;
    vec3 n = unpackNormal(imageLoad(normals, p + guard).x);
    // A neighbour's distance to this pixel's tangent plane, computed from pixel and depth without its position.
    bool orthographic = view.orthographic > 0.5;
    vec2 slope = n.xy * view.unproject.xy;
    float ray = dot((vec2(p + guard) + 0.5), slope) + dot(n.xy, view.unproject.zw), plane = ray * (orthographic ? 1.0 : z) - n.z * z;
    float sharpness = kPlane / z;
    ivec2 first = ivec2(floor(place)) - int(constants.before);
    int end = int(constants.taps);
    vec2 sum = vec2(0.0);
    int y = 0;
    while (true) {
        int x = 0;
        while (true) {
            ivec2 at = first + ivec2(x, y), q = clamp(at, ivec2(0), last), pixel = pixelOfMap(q, constants.map, visible);
            uvec2 share = imageLoad(shares, q).xy;
            float there = shareDepth(share);
            float off = (ray + dot(vec2(pixel - p), slope)) * (orthographic ? 1.0 : there) - n.z * there - plane;
            float cosine = max(dot(n, shareNormal(share)), kAcross);
            cosine *= cosine;
            vec2 window = clamp(constants.covers - abs(vec2(at) - place), 0.0, 1.0);
            float w = at == q ? window.x * window.y * cosine * cosine / (1.0 + sharpness * abs(off)) : 0.0;
            sum += (pixel == p ? 1.0 : w) * shareIntegrals(share);
            if (++x >= end) break;
        }
        if (++y >= end) break;
    }
    float blocked = isSky(view, z) ? 0.0 : clamp(sum.x / max(sum.y, 1e-6), 0.0, 1.0);
#ifdef TO_MAP
    imageStore(gathered, here, uvec4(packShare(z, n, blocked, 1.0), 0u, 0u));
#else
    imageStore(visibility, here, vec4(1.0 - blocked));
#endif
}
