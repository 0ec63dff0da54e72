// Vertices of depth layers: position and shell; with MASKED also what the alpha test needs.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant MASKED
#include "scene/placed.glsl"

layout(location = 0) in vec3 inPosition;
layout(location = 0) flat out float outShell;
#ifdef MASKED
layout(location = 1) in vec4 inUv;
layout(location = 2) in vec4 inColor;
layout(location = 1) out vec4 outUv;
layout(location = 2) out float outAlpha;
#endif

invariant gl_Position;

void main() {
    gl_Position = clipOf(eyeOf(inPosition));
    outShell = DRAW.normal[2].w;
#ifdef MASKED
    outUv = inUv;
    outAlpha = inColor.a;
#endif
}
