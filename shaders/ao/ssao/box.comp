// Mean of 4x4 pixels: removes the 4x4 noise pattern and blurs edges.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r16f) uniform readonly image2D source;
layout(set = 0, binding = 1, r16f) uniform writeonly image2D result;
layout(push_constant) uniform Block { Whole constants; };

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = constants.size - 1;
    if (any(greaterThan(p, last))) return;
    float sum = 0.0;
    for (int i = 0; i < 16; ++i) sum += imageLoad(source, clamp(p + ivec2(i & 3, i >> 2) - 2, ivec2(0), last)).x;
    imageStore(result, p, vec4(sum / 16.0));
}
