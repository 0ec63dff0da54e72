// Where a surface is, and of which solid.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/placed.glsl"

layout(location = 0) in vec3 inPosition;

layout(location = 0) flat out float outShell;

invariant gl_Position;

void main() {
    gl_Position = clipOf(eyeOf(inPosition));
    outShell = DRAW.normal[2].w;
}
