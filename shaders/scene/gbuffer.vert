// Positions and normals into eye space; where the vertex was last frame. Shared by the G-buffer and blended surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/frame.h"

layout(set = 0, binding = 0) uniform FrameUniform { SceneFrame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Draws { DrawItem draws[]; };

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
layout(location = 6) flat out float outStill;

#define DRAW draws[gl_InstanceIndex]

void main() {
    vec4 p = vec4(inPosition, 1.0);
    outEye = vec3(dot(DRAW.eye[0], p), dot(DRAW.eye[1], p), dot(DRAW.eye[2], p));
    gl_Position = frame.projection * vec4(outEye, 1.0);

    vec4 q = vec4(inPrevious, 1.0);
    outPrevious = vec3(dot(DRAW.previous[0], q), dot(DRAW.previous[1], q), dot(DRAW.previous[2], q));
    outStill = DRAW.normal[0].w;

    outNormal = vec3(dot(DRAW.normal[0].xyz, inNormal), dot(DRAW.normal[1].xyz, inNormal), dot(DRAW.normal[2].xyz, inNormal));
    outTangent.xyz = vec3(dot(DRAW.eye[0].xyz, inTangent.xyz), dot(DRAW.eye[1].xyz, inTangent.xyz), dot(DRAW.eye[2].xyz, inTangent.xyz));
    outTangent.w = inTangent.w * DRAW.normal[1].w;
    outUv = inUv;
    outColor = inColor;
}
