// Vertices of depth layers: position and shell.
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
