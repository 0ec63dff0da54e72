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
layout(set = 0, binding = 5) uniform sampler2D depthMap;              // linear depth of opaque surfaces
layout(set = 0, binding = 6) uniform sampler2D visibilityMap;         // theirs, visible size

layout(location = 0) in vec3 inEye;
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec4 inTangent;
layout(location = 3) in vec4 inUv;
layout(location = 4) in vec4 inColor;

layout(location = 0) out vec4 outColor;

// The depth buffer knows no blended surfaces. One that lies close to the opaque surface behind it is as occluded as that; one farther than
// kClose in front of it is open.
const float kClose = 0.25;  // metres along the view axis
float visibilityBehind(float depth) {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float gap = texelFetch(depthMap, p, 0).x - depth;
    return mix(texelFetch(visibilityMap, p - ivec2(light.view.guard), 0).x, 1.0, smoothstep(0.0, kClose, gap));
}

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
        s.visibility = occlusionOf(inUv) * visibilityBehind(-inEye.z);
        lit = shade(light, s, sunlight(light, shadowMap, shadowCompared, s.position, s.geometric));
    }
    outColor = vec4((lit + emissionOf(inUv)) * color.a, color.a);
}
