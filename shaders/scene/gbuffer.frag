// G-buffer of opaque and alpha-masked surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/face.glsl"
#include "scene/frame.h"
#include "scene/material.glsl"
#include "scene/surface.glsl"
#include "shared/octahedral.glsl"

layout(constant_id = 0) const bool kMasked = false;

layout(set = 0, binding = 0) uniform FrameUniform { SceneFrame frame; };

layout(location = 0) in vec3 inEye;
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec4 inTangent;
layout(location = 3) in vec4 inUv;
layout(location = 4) in vec4 inColor;
layout(location = 5) in vec3 inPrevious;
layout(location = 6) flat in vec2 inFacts;

layout(location = 0) out uint outGeometric;
layout(location = 1) out uint outShaded;
layout(location = 2) out vec2 outMotion;
layout(location = 3) out vec4 outBaseColor;  // a: occlusion map
layout(location = 4) out vec4 outMaterial;   // roughness, metalness, unlit, face (face.glsl), the last in the guard band too
layout(location = 5) out vec4 outEmission;

vec2 motion() {
    if (inFacts.x > 0.5) return vec2(0.0);
    if (inPrevious.z <= 0.0) return vec2(kFarAway);  // was behind the camera: no history
    vec2 before = (inPrevious.xy / inPrevious.z + 1.0) * frame.viewport.zw;
    return clamp(before - gl_FragCoord.xy, -kFarAway, kFarAway);
}

// False in the guard band, where only depth, geometric normals and motion are read. The same for all pixels of a quad, so that texture
// derivatives are defined.
bool isVisible() {
    vec2 quad = floor(gl_FragCoord.xy * 0.5);
    return all(greaterThanEqual(quad, frame.visibleQuads.xy)) && all(lessThan(quad, frame.visibleQuads.zw));
}

void main() {
    vec3 geometric = geometricNormal(inEye, inNormal, frame.orthographic.x > 0.5);  // before discard: needs whole quads
    outGeometric = packNormal(geometric);
    outMotion = motion();
    outShaded = outGeometric;
    outBaseColor = outEmission = vec4(0.0);
    float face = float(faceOf(inFacts.y)) / 255.0;
    outMaterial = vec4(0.0, 0.0, 0.0, face);
    bool full = isVisible();
    if (full || kMasked) {
        vec4 color = baseColorOf(inUv, inColor);
        if (kMasked && color.a < material.emission.w) discard;
        outBaseColor = vec4(color.rgb, 1.0);
    }
    if (full) {
        vec2 metalRough = metalRoughOf(inUv);
        outShaded = packNormal(normalOf(inUv, inNormal, inTangent, gl_FrontFacing ? 1.0 : -1.0));
        outBaseColor.a = occlusionOf(inUv);
        outMaterial = vec4(metalRough.y, metalRough.x, material.flags.y != 0u ? 1.0 : 0.0, face);
        outEmission = vec4(emissionOf(inUv), 1.0);
    }
}
