// Merges two images of visibility, or with DIRECTIONS of bent normals: the first left of a divider, the second right of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant DIRECTIONS
#ifdef DIRECTIONS
#define FORMAT rgba8_snorm
#else
#define FORMAT r16f
#endif
#include "post/view.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, FORMAT) uniform readonly image2D left;
layout(set = 0, binding = 1, FORMAT) uniform readonly image2D right;
layout(set = 0, binding = 2, FORMAT) uniform writeonly image2D both;

layout(push_constant) uniform Constants { SplitBlock split; };

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(split.visible)))) return;
    imageStore(both, at, at.x < int(split.divider) ? imageLoad(left, at) : imageLoad(right, at));
}
