// Gather of interleaved shares from neighbours of similar depth; see ao/common/gather.glsl. In: linear depth, packed normals.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#include "ao/far_field/similar.glsl"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
const bool kWeighted = true;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3) uniform sampler2D shares;
layout(set = 0, binding = 4) uniform sampler2D open;
layout(set = 0, binding = 5, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Block { Gather constants; };

ivec2 pixels(View view) { return ivec2(view.visible); }
float surfaceAt(View view, ivec2 p, out vec3 here, out vec3 n) {
    ivec2 texel = p + ivec2(view.guard);
    float z = imageLoad(depth, texel).x;
    here = eyePosition(view, vec2(texel) + 0.5, z);
    n = unpackNormal(imageLoad(normals, texel).x);
    return z;
}
#define ofSurface similar
#include "ao/common/gather.glsl"
