// place.vert for alpha-masked surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/placed.glsl"

layout(location = 0) in vec3 inPosition;
layout(location = 1) in vec4 inUv;
layout(location = 2) in vec4 inColor;

layout(location = 0) flat out float outShell;
layout(location = 1) out vec4 outUv;
layout(location = 2) out float outAlpha;

invariant gl_Position;

void main() {
    gl_Position = clipOf(eyeOf(inPosition));
    outShell = DRAW.normal[2].w;
    outUv = inUv;
    outAlpha = inColor.a;
}
