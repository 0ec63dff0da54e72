// Brings together what the pixels of a tile found: the side x side around, their outer rows counting half where the side is even, so that
// each share of the slices weighs the same and no tile shows. Neighbours count by how well they lie on this pixel's surface; what is
// averaged is what was blocked and what could have been: where an edge leaves some shares out, slices that hold more of the hemisphere
// than others do not tip the scale. Where the shares are those of a map, the map's pixels gather first, and then the picture's among the
// four of the map around each.
// In: linear depth, packed normals; parts of each pixel or of a map's. Out: visibility, or with TO_MAP what each of the map's gathered.
#ifndef OBSCURA_LAYERED_GATHER_GLSL
#define OBSCURA_LAYERED_GATHER_GLSL
#include "ao/layered/parts.glsl"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, rg32ui) uniform readonly uimage2D parts;
#ifdef TO_MAP
layout(set = 0, binding = 4, rg32ui) uniform writeonly uimage2D gathered;
#else
layout(set = 0, binding = 4, r16f) uniform writeonly image2D visibility;
#endif
layout(push_constant) uniform Constants {
    uint map;      // pixels that one of the parts stands for, each way
    uint before;   // how many of them to look at before the one at or left of a pixel,
    uint taps;     // and in all, each way
    float covers;  // how far they count, of the parts' pixels; half a pixel more than half of a tile
};

const float kAcross = 0.03;   // cosine that counts where surfaces turn away: where a map shows nothing of a surface, others must do
const float kPlane = 1000.0;  // per plane distance over depth: half the weight a thousandth of the depth off the surface

void main() {
    View view = viewBlock;  // a copy, so that the loop holds it in registers
    ivec2 here = ivec2(gl_GlobalInvocationID.xy), visible = ivec2(view.visible), last = imageSize(parts) - 1, guard = ivec2(view.guard);
#ifdef TO_MAP
    if (any(greaterThan(here, last))) return;
    ivec2 p = pixelOfMap(here, map, visible);
    vec2 place = vec2(here);
#else
    if (any(greaterThanEqual(here, visible))) return;
    ivec2 p = here;
    vec2 place = (vec2(p) - float(map / 2u)) / float(map);
#endif
    float z = imageLoad(depth, p + guard).x;
    vec3 n = unpackNormal(imageLoad(normals, p + guard).x);
    // A neighbour's distance to this pixel's tangent plane, told in pixels and depth: none of them needs its position.
    bool orthographic = view.orthographic > 0.5;
    vec2 slope = n.xy * view.unproject.xy;
    float aside = dot((vec2(p + guard) + 0.5), slope) + dot(n.xy, view.unproject.zw), plane = aside * (orthographic ? 1.0 : z) - n.z * z;
    float sharpness = kPlane / z;
    ivec2 first = ivec2(floor(place)) - int(before);
    int end = int(taps);
    vec2 sum = vec2(0.0);
    int y = 0;
    while (true) {
        int x = 0;
        while (true) {
            ivec2 at = first + ivec2(x, y), q = clamp(at, ivec2(0), last), pixel = pixelOfMap(q, map, visible);
            uvec2 part = imageLoad(parts, q).xy;
            float there = partDepth(part);
            float off = (aside + dot(vec2(pixel - p), slope)) * (orthographic ? 1.0 : there) - n.z * there - plane;
            float facing = max(dot(n, partNormal(part)), kAcross);
            facing *= facing;
            vec2 rim = clamp(covers - abs(vec2(at) - place), 0.0, 1.0);
            float w = at == q ? rim.x * rim.y * facing * facing / (1.0 + sharpness * abs(off)) : 0.0;
            sum += (pixel == p ? 1.0 : w) * partShares(part);
            if (++x >= end) break;
        }
        if (++y >= end) break;
    }
    float blocked = isSky(view, z) ? 0.0 : clamp(sum.x / max(sum.y, 1e-6), 0.0, 1.0);
#ifdef TO_MAP
    imageStore(gathered, here, uvec4(packPart(z, n, blocked, 1.0), 0u, 0u));
#else
    imageStore(visibility, here, vec4(1.0 - blocked));
#endif
}

#endif
