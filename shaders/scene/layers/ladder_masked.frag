// ladder.frag with the alpha test of masked surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/layers/ladder.glsl"
#include "scene/material.glsl"

layout(location = 1) in vec4 inUv;
layout(location = 2) in float inAlpha;

void main() {
    if (baseColorOf(inUv, vec4(1.0, 1.0, 1.0, inAlpha)).a < material.emission.w) return;
    insertHit();
}
