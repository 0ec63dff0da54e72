// Depth prepass of textured opaque surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/placed.glsl"

layout(location = 0) in vec3 inPosition;

invariant gl_Position;

void main() { gl_Position = clipOf(eyeOf(inPosition)); }
