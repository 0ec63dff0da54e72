// A part of a host's image -> an image of its own: up to two floats, up to four, or an unsigned integer.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant FOUR
#pragma variant INTEGER
#include "ao/common/constants.h"
layout(local_size_x = 8, local_size_y = 8) in;
#ifdef INTEGER
layout(set = 0, binding = 0) uniform usampler2D source;
layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D part;
#else
layout(set = 0, binding = 0) uniform sampler2D source;
#ifdef FOUR
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D part;
#else
layout(set = 0, binding = 1, rg32f) uniform writeonly image2D part;
#endif
#endif
layout(push_constant) uniform Block { Crop constants; };

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, constants.size))) return;
    imageStore(part, p, texelFetch(source, p + constants.origin, 0));
}
