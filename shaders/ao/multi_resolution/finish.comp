// Combines the finest level with all coarser ones, then maximum and mean into visibility [Hoang and Low 2012, eq. 11]. Like combine.comp,
// but writes visibility, R16F, of the visible part.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant GATHERED
#include "ao/multi_resolution/upsample.glsl"
layout(set = 0, binding = 8, r16f) uniform writeonly image2D visibility;

void main() {
    View view = viewBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, constants.area))) return;
    float z = imageLoad(depth, constants.origin + p).x;
    Surface here = surfaceOf(view, vec2(constants.origin + p) + 0.5, z, imageLoad(normals, constants.origin + p).x);
    Obscurance o = combined(view, p, here, ownOf(p, here.n));
    vec2 open = 1.0 - clamp(vec2(along(o.most, here.n), o.count > 0.0 ? along(o.sum, here.n) / o.count : 0.0), 0.0, 1.0);
    imageStore(visibility, p, vec4(isSky(view, z) ? 1.0 : open.x * open.y));
}
