// Obscurance: every sector of a pixel, near and far [Timonen 2013, alg. 2].
// In: linear depth, packed normals, directions, cells, the falloff's table. Out: visibility. With
// BATCH only of a batch of directions and those before it, whose sums of (obscurance, widths) it adds to.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant SUMS
#pragma variant BATCH
#pragma variant SUMS,BATCH
layout(constant_id = 1) const uint kThin = 0;
#include "ao/far_field/sectors.glsl"
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 6, r16f) uniform writeonly image2D visibility;
#ifdef BATCH
layout(set = 0, binding = 7, rg32f) uniform image2D sums;
#endif

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    FarFieldConstants c = constants;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 texel = p + ivec2(view.guard);
    float z = imageLoad(depth, texel).x;
    if (isSky(view, z)) {
        imageStore(visibility, p, vec4(1.0));
        return;
    }
    Receiver r = receiverAt(view, texel, z, unpackNormal(imageLoad(normals, texel).x));
    Turn turn = jittered(turnOf(c), view, texel, c);
    vec2 sum = vec2(0.0);
    for (uint i = 0u;;) {  // post-tested, see sectors.glsl
        sum += sectorOf(r, directionOf(c, i), c, turn, view.skyDepth);
        if ((i += c.stride) >= batchOf(c)) break;
    }
#ifdef BATCH
    if (c.first > 0u) sum += imageLoad(sums, p).xy;
    imageStore(sums, p, vec4(sum, 0.0, 0.0));
#endif
    imageStore(visibility, p, vec4(clamp(1.0 - 2.0 * sum.x / sum.y, 0.0, 1.0)));
}
