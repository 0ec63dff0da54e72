// peel_on.frag with the alpha test of masked surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#define WHOLE_HITS
#include "scene/layers/peel.glsl"
#include "scene/material.glsl"

layout(location = 1) in vec4 inUv;
layout(location = 2) in float inAlpha;

void main() {
    if (baseColorOf(inUv, vec4(1.0, 1.0, 1.0, inAlpha)).a < material.emission.w) discard;
    peel();
}
