// Samples of one level; see sample.glsl. Out: an Obscurance per texel of the level's area.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "sample.glsl"
layout(set = 0, binding = 3, r32ui) uniform writeonly uimage2D near;
layout(set = 0, binding = 4, r32ui) uniform writeonly uimage2D directions;

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, constants.area))) return;
    float count;
    vec3 n, sum = sampled(p, 0, 1, count, n);
    uvec2 result = packed(Obscurance(sum / max(count, 1.0), sum, count), n);
    imageStore(near, p, uvec4(result.x));
    if (kDirected && constants.texel > 1.0) imageStore(directions, p, uvec4(result.y));
}
