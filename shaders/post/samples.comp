// Samples every step-th pixel of the visible part into one small image for readback: visibility, depth, normal, motion.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "post/view.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D first;    // visibility of A, visible size
layout(set = 0, binding = 1) uniform sampler2D second;   // visibility of B, or of A again
layout(set = 0, binding = 2) uniform sampler2D depth;    // linear; this and the following with guard band
layout(set = 0, binding = 3) uniform usampler2D normals;
layout(set = 0, binding = 4) uniform sampler2D motion;
layout(set = 0, binding = 5, rgba32ui) uniform writeonly uimage2D samples;

layout(push_constant) uniform Constants { SamplesBlock block; };

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(block.count)))) return;
    ivec2 pixel = at * int(block.step) + int(block.step / 2u), whole = pixel + ivec2(block.guard);
    vec2 visibility = vec2(texelFetch(first, pixel, 0).x, texelFetch(second, pixel, 0).x);
    imageStore(samples, at, uvec4(packHalf2x16(visibility), floatBitsToUint(texelFetch(depth, whole, 0).x), texelFetch(normals, whole, 0).x,
                                  packHalf2x16(texelFetch(motion, whole, 0).xy)));
}
