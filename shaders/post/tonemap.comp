// Tone mapping: exposure, the ACES filmic curve, sRGB encoding. In: linear radiance. Out: the image of the visible part.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "post/view.h"
#include "post/srgb.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D lit;
layout(set = 0, binding = 1, rgba8) writeonly uniform image2D picture;

layout(push_constant) uniform Constants { ViewBlock view; };

// RRT and ODT fitted by Stephen Hill; the matrices take sRGB primaries into its working space and back.
vec3 aces(vec3 color) {
    const mat3 into = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 back = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    vec3 v = into * color;
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return clamp(back * v, 0.0, 1.0);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(view.visible)))) return;
    vec3 color = texelFetch(lit, at + ivec2(view.offset), 0).rgb;
    imageStore(picture, at, vec4(encodeSrgb(aces(color * view.exposure)), 1.0));
}
