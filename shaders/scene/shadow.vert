// Vertices of the shadow map; with MASKED also what the alpha test needs.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant MASKED
#include "scene/frame.h"

layout(set = 0, binding = 0, std430) readonly buffer Draws { ShadowItem draws[]; };

layout(location = 0) in vec3 inPosition;
#ifdef MASKED
layout(location = 1) in vec4 inUv;
layout(location = 2) in vec4 inColor;
layout(location = 0) out vec4 outUv;
layout(location = 1) out float outAlpha;
#endif

void main() {
    vec4 p = vec4(inPosition, 1.0);
    gl_Position = vec4(dot(draws[gl_InstanceIndex].clip[0], p), dot(draws[gl_InstanceIndex].clip[1], p),
                       dot(draws[gl_InstanceIndex].clip[2], p), 1.0);
#ifdef MASKED
    outUv = inUv;
    outAlpha = inColor.a;
#endif
}
