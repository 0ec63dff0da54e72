// Vertex transforms, shared by the depth prepass, the G-buffer and depth layers, whose depths must agree to the bit.
#ifndef OBSCURA_SCENE_PLACED_GLSL
#define OBSCURA_SCENE_PLACED_GLSL
#include "scene/frame.h"

layout(set = 0, binding = 0) uniform FrameUniform { SceneFrame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Draws { DrawItem draws[]; };

#define DRAW draws[gl_InstanceIndex]

vec3 eyeOf(vec3 position) {
    vec4 p = vec4(position, 1.0);
    return vec3(dot(DRAW.eye[0], p), dot(DRAW.eye[1], p), dot(DRAW.eye[2], p));
}
vec4 clipOf(vec3 eye) { return frame.projection * vec4(eye, 1.0); }

#endif
