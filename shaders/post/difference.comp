// Difference of two visibility images: its size as grey, or signed in false colours.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "post/false_colour.h"
#include "post/view.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, r16f) uniform readonly image2D first;
layout(set = 0, binding = 1, r16f) uniform readonly image2D second;
layout(set = 0, binding = 2, rgba8) uniform writeonly image2D picture;

layout(push_constant) uniform Constants { DifferenceBlock block; };

vec3 falseColour(float value) {
    vec3 low = value < 0.0 ? kBelow[0] : kAbove[0], middle = value < 0.0 ? kBelow[1] : kAbove[1],
         high = value < 0.0 ? kBelow[2] : kAbove[2];
    float t = 2.0 * min(abs(value), 1.0);
    return mix(mix(low, middle, min(t, 1.0)), high, max(t - 1.0, 0.0)) / 255.0;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(block.visible)))) return;
    float value = (imageLoad(first, at).x - imageLoad(second, at).x) * block.scale;
    imageStore(picture, at, vec4(block.withSign != 0u ? falseColour(value) : vec3(min(abs(value), 1.0)), 1.0));
}
