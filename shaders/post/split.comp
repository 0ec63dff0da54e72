// Merges two visibility images: the first left of a divider, the second right of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "post/view.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, r16f) uniform readonly image2D left;
layout(set = 0, binding = 1, r16f) uniform readonly image2D right;
layout(set = 0, binding = 2, r16f) uniform writeonly image2D both;

layout(push_constant) uniform Constants { SplitBlock split; };

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(split.visible)))) return;
    float a = imageLoad(left, at).x, b = imageLoad(right, at).x;
    imageStore(both, at, vec4(at.x < int(split.divider) ? a : b, 0.0, 0.0, 0.0));
}
