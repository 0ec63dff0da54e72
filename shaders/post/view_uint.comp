// Debug view of an integer image: packed normals as n/2 + 1/2, temporal history, or the low byte of each channel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "post/view.h"
#include "shared/octahedral.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform usampler2D source;
layout(set = 0, binding = 1, rgba8) writeonly uniform image2D picture;

layout(push_constant) uniform Constants { ViewBlock view; };

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(view.visible)))) return;
    ivec2 from = clamp(ivec2((vec2(at) + 0.5) * view.scale + view.offset), ivec2(0), textureSize(source, 0) - 1);
    uvec4 texel = texelFetch(source, from, 0);
    vec3 color = view.mode == kViewNormal ? unpackNormal(texel.x) * 0.5 + 0.5 : vec3(texel.xyz & 255u) / 255.0;
    float frames = float(texel.y >> 14 & 63u);
    if (view.mode == kViewHistory) color = vec3(log2(1.0 + frames) / 6.0);
    if (view.mode == kViewRejected) color = vec3(frames == 1.0 ? 1.0 : 0.0);
    imageStore(picture, at, vec4(color, 1.0));
}
