// Level 0 of the depth pyramid: (depth, 1), or zeros for sky.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View view; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, rg32f) uniform writeonly image2D base;

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.size)))) return;
    float z = imageLoad(depth, p).x;
    imageStore(base, p, isSky(view, z) ? vec4(0.0) : vec4(z, 1.0, 0.0, 0.0));
}
