// A part of a host's image -> an image of its own: up to two floats, up to four, or an unsigned integer; of several samples the first.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant FOUR
#pragma variant INTEGER
#pragma variant MULTISAMPLE
#pragma variant FOUR,MULTISAMPLE
#pragma variant INTEGER,MULTISAMPLE
#include "ao/common/constants.h"
layout(local_size_x = 8, local_size_y = 8) in;
#ifdef MULTISAMPLE
#define FLOATS sampler2DMS
#define INTEGERS usampler2DMS
#define SIZE_OF(image) textureSize(image)
#else
#define FLOATS sampler2D
#define INTEGERS usampler2D
#define SIZE_OF(image) textureSize(image, 0)
#endif
#ifdef INTEGER
layout(set = 0, binding = 0) uniform INTEGERS source;
layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D part;
#else
layout(set = 0, binding = 0) uniform FLOATS source;
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
    ivec2 q = (constants.origin + p * constants.stride) >> constants.shift;
    imageStore(part, p, texelFetch(source, min(q, SIZE_OF(source) - 1), 0));
}
