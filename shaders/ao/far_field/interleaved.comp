// Far-field obscurance of this pixel's share of the sectors: share g has the directions g, g + n^2, g + 2 n^2 ... [Timonen 2013, sec. 10].
// With BATCH only of a batch of directions, added to those before it.
// In: linear depth, averaged surfaces, directions, cells, the falloff's table. Out: (obscurance times sector widths, sector widths),
// summed.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant SUMS
#pragma variant BATCH
#pragma variant SUMS,BATCH
#include "ao/common/tile.glsl"
const uint kThin = 0u;
#include "ao/far_field/sectors.glsl"
layout(set = 0, binding = 2, rg32ui) uniform readonly uimage2D surfaces;
#ifdef BATCH
layout(set = 0, binding = 6, rg16f) uniform image2D shares;
#else
layout(set = 0, binding = 6, rg16f) uniform writeonly image2D shares;
#endif

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    FarFieldConstants c = constants;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    uvec2 surface = imageLoad(surfaces, p).xy;
    float z = uintBitsToFloat(surface.y);
    vec2 sum = vec2(0.0);
    if (!isSky(view, z)) {
        ivec2 texel = p + ivec2(view.guard);
        Receiver r = receiverAt(view, texel, z, unpackNormal(surface.x));
        Turn turn = turnedBy(turnOf(c), c, jitterAt(view, texel, halfWidthOf(c), c.jitter));
        for (uint k = shareOf(view, p, c.side); k < c.directions; k += c.side * c.side) {
#ifdef BATCH
            if (!inBatch(c, k)) continue;
#endif
            sum += sectorOf(r, k, c, turn, view.skyDepth);
        }
    }
    vec2 share = vec2(2.0 * sum.x, sum.y);
#ifdef BATCH
    if (c.first > 0u) share += imageLoad(shares, p).xy;
#endif
    imageStore(shares, p, vec4(share, 0.0, 0.0));
}
