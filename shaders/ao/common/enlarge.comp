// Visibility of fewer pixels -> of all (runtime/ao/reduction.h). A pixel takes the bilinear mean of those of its four reduced neighbours
// that are on its surface; where none is, the mean of those of the next twelve that are; else the neighbour that is nearest to its plane.
// In: linear depth and normals of the frame and of the reduced pixels, visibility of these. Out: visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#include "ao/common/tile.glsl"
#include "shared/octahedral.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, std140) uniform ReducedBlock { View reducedBlock; };
layout(set = 0, binding = 4, r32f) uniform readonly image2D reducedDepth;
layout(set = 0, binding = 5, r32ui) uniform readonly uimage2D reducedNormals;
layout(set = 0, binding = 6, r16f) uniform readonly image2D visibility;
layout(set = 0, binding = 7, r16f) uniform writeonly image2D result;
layout(push_constant) uniform Block { Enlarge constants; };

void main() {
    View view = viewBlock, reduced = reducedBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), own = p + ivec2(view.guard), last = ivec2(reduced.visible) - 1;
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    float z = imageLoad(depth, own).x;
    if (isSky(view, z)) {
        imageStore(result, p, vec4(1.0));
        return;
    }
    vec3 here = eyePosition(view, vec2(own) + 0.5, z), n = unpackNormal(imageLoad(normals, own).x);
    float tolerance = depthForTolerance(view, z);
    vec2 at = (vec2(p) - constants.chosen) * constants.perScale, corner = floor(at), fraction = at - corner;
    float sum = 0.0, weights = 0.0, nearest = 1e30, fallback = 1.0;
    for (int i = 0; i < 16; ++i) {
        if (i == 4 && weights > 0.0) break;
        // The four around the pixel, then the twelve around those.
        int k = i - 4;
        ivec2 step = i < 4 ? ivec2(i & 1, i >> 1)
                           : k < 4 ? ivec2(k - 1, -1) : k < 8 ? ivec2(k - 5, 2) : ivec2(k < 10 ? -1 : 2, k & 1);
        ivec2 at = ivec2(corner) + step, q = clamp(at, ivec2(0), last), texel = q + ivec2(reduced.guard);
        float zq = imageLoad(reducedDepth, texel).x, value = imageLoad(visibility, q).x;
        vec3 there = eyePosition(reduced, vec2(texel) + 0.5, zq);
        bool same = !isSky(reduced, zq) && ofSurface(here, n, tolerance, there, unpackNormal(imageLoad(reducedNormals, texel).x));
        vec2 w2 = mix(1.0 - fraction, fraction, vec2(step));
        float w = same ? (i < 4 ? max(w2.x * w2.y, 1e-4) : 1.0) : 0.0;
        sum += w * value;
        weights += w;
        float off = abs(dot(there - here, n));
        fallback = off < nearest ? value : fallback;
        nearest = min(nearest, off);
    }
    imageStore(result, p, vec4(weights > 0.0 ? sum / weights : fallback));
}
