// Vertices of the G-buffer and of blended surfaces: eye-space position, normal and tangent, and last frame's clip position.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/placed.glsl"

layout(location = 0) in vec3 inPosition;
layout(location = 1) in vec3 inPrevious;
layout(location = 2) in vec3 inNormal;
layout(location = 3) in vec4 inTangent;
layout(location = 4) in vec4 inUv;
layout(location = 5) in vec4 inColor;

layout(location = 0) out vec3 outEye;
layout(location = 1) out vec3 outNormal;
layout(location = 2) out vec4 outTangent;
layout(location = 3) out vec4 outUv;
layout(location = 4) out vec4 outColor;
layout(location = 5) out vec3 outPrevious;  // clip x, y, w
layout(location = 6) flat out vec2 outFacts;  // 1 if object and camera have not moved; shell

invariant gl_Position;

void main() {
    outEye = eyeOf(inPosition);
    gl_Position = clipOf(outEye);

    vec4 q = vec4(inPrevious, 1.0);
    outPrevious = vec3(dot(DRAW.previous[0], q), dot(DRAW.previous[1], q), dot(DRAW.previous[2], q));
    outFacts = vec2(DRAW.normal[0].w, DRAW.normal[2].w);

    outNormal = vec3(dot(DRAW.normal[0].xyz, inNormal), dot(DRAW.normal[1].xyz, inNormal), dot(DRAW.normal[2].xyz, inNormal));
    outTangent.xyz = vec3(dot(DRAW.eye[0].xyz, inTangent.xyz), dot(DRAW.eye[1].xyz, inTangent.xyz), dot(DRAW.eye[2].xyz, inTangent.xyz));
    outTangent.w = inTangent.w * DRAW.normal[1].w;
    outUv = inUv;
    outColor = inColor;
}
