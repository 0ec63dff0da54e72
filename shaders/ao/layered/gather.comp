// Gather of interleaved shares over side x side neighbours. For an even side the window is one pixel wider and its outer rows have half
// weight, so that all shares weigh the same and no tile pattern is left. Neighbours are weighted by their distance to this pixel's tangent
// plane. Blocked and whole integrals are averaged separately, so that an edge that excludes some slices adds no bias. With a map, map
// pixels gather first; image pixels then gather from the four map pixels around them, which is bilinear along a surface.
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

const float kPlane = 1000.0;  // per plane distance / depth: half the weight at a thousandth of the depth

void main() {
    View view = viewBlock;  // a copy, so that the loop holds it in registers
    ivec2 here = ivec2(gl_GlobalInvocationID.xy), visible = ivec2(view.visible), last = constants.size - 1, guard = ivec2(view.guard);
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
    // A neighbour's distance to the tangent plane, from its depth and pixel: n.r is linear over the image, r the view ray.
    bool orthographic = view.orthographic > 0.5;
    vec3 n = unpackNormal(imageLoad(normals, p + guard).x);
    vec2 slope = n.xy * view.unproject.xy;
    float ray = dot(vec2(p + guard) + 0.5, slope) + dot(n.xy, view.unproject.zw), plane = ray * (orthographic ? 1.0 : z) - n.z * z;
    float sharpness = kPlane / depthForTolerance(view, z);
    ivec2 first = ivec2(floor(place)) - int(constants.before);
    // The neighbour's ray; neighbours beyond the image's edge are taken to be at its map pixel's place all the same.
    float firstRay = ray + dot(vec2(first * int(constants.map) + int(constants.map / 2u) - p), slope);
    vec2 stepRay = slope * float(constants.map);
    int end = int(constants.taps);
    vec2 sum = vec2(0.0);
    int y = 0;
    while (true) {
        float window = clamp(constants.covers - abs(float(first.y + y) - place.y), 0.0, 1.0);
        int x = 0;
        while (true) {
            uvec2 share = imageLoad(shares, clamp(first + ivec2(x, y), ivec2(0), last)).xy;
            float there = shareDepth(share);
            float off = (firstRay + dot(vec2(x, y), stepRay)) * (orthographic ? 1.0 : there) - n.z * there - plane;
            float w = window * clamp(constants.covers - abs(float(first.x + x) - place.x), 0.0, 1.0) / (1.0 + sharpness * abs(off));
            sum += w * shareIntegrals(share);
            if (++x >= end) break;
        }
        if (++y >= end) break;
    }
    float blocked = isSky(view, z) ? 0.0 : clamp(sum.x / max(sum.y, 1e-6), 0.0, 1.0);
#ifdef TO_MAP
    imageStore(gathered, here, packShare(z, blocked, 1.0));
#else
    imageStore(visibility, here, vec4(1.0 - blocked));
#endif
}
