// Interleaved samples of the finest level; see sample.glsl. Out: for the shared gather, (obscurance sum, sample count) of each pixel's
// share.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/tile.glsl"
#include "sample.glsl"
layout(set = 0, binding = 3, rg16f) uniform writeonly image2D shares;

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, constants.area))) return;
    float count;
    vec3 n, sum = sampled(p, int(shareOf(viewBlock, p, constants.side)), int(constants.side * constants.side), count, n);
    imageStore(shares, p, vec4(along(sum, n), count, 0, 0));
}
