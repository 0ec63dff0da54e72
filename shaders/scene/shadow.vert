// Vertices of the shadow map.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/frame.h"

layout(set = 0, binding = 0, std430) readonly buffer Draws { ShadowItem draws[]; };

layout(location = 0) in vec3 inPosition;

void main() {
    vec4 p = vec4(inPosition, 1.0);
    gl_Position = vec4(dot(draws[gl_InstanceIndex].clip[0], p), dot(draws[gl_InstanceIndex].clip[1], p),
                       dot(draws[gl_InstanceIndex].clip[2], p), 1.0);
}
