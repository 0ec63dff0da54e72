// Averages raw bent normals over neighbours on the same surface and normalises; see runtime/ao/bent_normals.h. A window of an even tile is
// one pixel wider and its outer pixels have half weight, so that all pixels of the tile weigh the same.
// In: linear depth, packed normals, raw bent normals of the picture's or a map's pixels, visibility. Out: bent normal, visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/bent_normals.glsl"
#include "ao/common/constants.h"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, rg32ui) uniform readonly uimage2D raw;
layout(set = 0, binding = 4, r16f) uniform readonly image2D visibility;
layout(set = 0, binding = 5, rgba8_snorm) uniform writeonly image2D result;
layout(push_constant) uniform Block { BentNormals constants; };

const float kPlane = 1000.0;  // per plane distance / depth: half the weight at a thousandth of the depth

void main() {
    View view = viewBlock;  // a copy, so that the loop holds it in registers
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), visible = ivec2(view.visible), guard = ivec2(view.guard);
    ivec2 last = (visible - 1) / int(constants.scale);
    if (any(greaterThanEqual(p, visible))) return;
    float z = imageLoad(depth, p + guard).x;
    if (isSky(view, z)) {
        imageStore(result, p, vec4(0.0, 0.0, 0.0, 1.0));
        return;
    }
    vec3 here = eyePosition(view, vec2(p + guard) + 0.5, z), n = unpackNormal(imageLoad(normals, p + guard).x);
    n = dot(n, towardsEye(view, here)) < 0.0 ? -n : n;
    int scale = int(constants.scale), middle = int(constants.middle);
    vec2 place = (vec2(p) - float(middle)) / float(scale);
    ivec2 first = ivec2(floor(place - constants.covers)) + 1;
    // A neighbour's distance to the tangent plane, from its depth and pixel: n.r is linear over the image, r the view ray. Neighbours
    // beyond the image's edge are taken to be at the map pixel's place all the same.
    bool orthographic = view.orthographic > 0.5;
    vec2 along = view.unproject.xy * n.xy;
    float ray = dot(vec2(first * scale + middle + guard) + 0.5, along) + dot(view.unproject.zw, n.xy), plane = dot(here, n);
    float sharpness = kPlane / depthForTolerance(view, z);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    int y = 0;
    while (true) {
        float row = clamp(constants.covers - abs(float(first.y + y) - place.y), 0.0, 1.0);
        int x = 0;
        while (true) {
            ivec2 q = clamp(first + ivec2(x, y), ivec2(0), last);
            uvec2 texel = imageLoad(raw, q).xy;
            vec3 m = directionOf(imageLoad(normals, min(q * scale + middle, visible - 1) + guard).x);
            float there = uintBitsToFloat(texel.x), rayThere = ray + float(scale) * dot(vec2(x, y), along);
            float off = (orthographic ? rayThere : rayThere * there) - n.z * there - plane, facing = dot(n, m);
            float w = row * clamp(constants.covers - abs(float(first.x + x) - place.x), 0.0, 1.0) * facing * facing /
                      (dot(m, m) * (1.0 + sharpness * abs(off)));
            sum += w * unpackBent(texel.y);
            weights += w;
            if (++x >= int(constants.taps)) break;
        }
        if (++y >= int(constants.taps)) break;
    }
    vec3 bent = kWholeBent * n - sum / max(weights, 1e-6);
    // Noise may turn what is left of a dark corner below the surface; where nothing is left, the normal remains.
    bent += n * (max(-dot(bent, n), 0.0) + 1e-3);
    imageStore(result, p, vec4(normalize(bent), imageLoad(visibility, p).x));
}
