// Gather of interleaved shares over a map of fewer pixels than the image (runtime/ao/upsample.h); see gather.glsl. In: the map's receivers;
// each is treated as if at the middle of its pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#include "ao/common/tile.glsl"
#include "shared/octahedral.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool kWeighted = false;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, rg32ui) uniform readonly uimage2D receivers;
layout(set = 0, binding = 2) uniform sampler2D shares;
layout(set = 0, binding = 3) uniform sampler2D open;
layout(set = 0, binding = 4, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Block { GatherMap constants; };

ivec2 pixels(View view) { return constants.size; }
float surfaceAt(View view, ivec2 p, out vec3 here, out vec3 n) {
    uvec2 receiver = imageLoad(receivers, p).xy;
    float z = uintBitsToFloat(receiver.x);
    here = eyePosition(view, vec2(view.guard) + (vec2(p) + 0.5) * constants.scale, z);
    n = unpackNormal(receiver.y);
    return z;
}
#include "gather.glsl"
