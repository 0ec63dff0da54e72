// Alpha-blended surfaces, forward-lit, premultiplied alpha.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/frame.h"
#include "scene/material.glsl"
#include "scene/shade.glsl"
#include "scene/surface.glsl"

layout(set = 0, binding = 0) uniform FrameUniform { SceneFrame frame; };
layout(set = 0, binding = 2) uniform Light { LightingBlock light; };
layout(set = 0, binding = 3) uniform sampler2D shadowMap;
layout(set = 0, binding = 4) uniform sampler2DShadow shadowCompared;  // the same image

layout(location = 0) in vec3 inEye;
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec4 inTangent;
layout(location = 3) in vec4 inUv;
layout(location = 4) in vec4 inColor;

layout(location = 0) out vec4 outColor;

void main() {
    Surface s;
    s.geometric = geometricNormal(inEye, inNormal, frame.orthographic.x > 0.5);
    vec4 color = baseColorOf(inUv, inColor);
    vec3 lit = color.rgb;
    if (material.flags.y == 0u) {
        vec2 metalRough = metalRoughOf(inUv);
        s.position = inEye;
        s.normal = normalOf(inUv, inNormal, inTangent, gl_FrontFacing ? 1.0 : -1.0);
        s.baseColor = color.rgb;
        s.roughness = metalRough.y;
        s.metalness = metalRough.x;
        s.visibility = occlusionOf(inUv);
        lit = shade(light, s, sunlight(light, shadowMap, shadowCompared, s.position, s.geometric));
    }
    outColor = vec4((lit + emissionOf(inUv)) * color.a, color.a);
}
