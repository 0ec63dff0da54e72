// Alpha test of masked surfaces in the shadow map.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/material.glsl"

layout(location = 0) in vec4 inUv;
layout(location = 1) in float inAlpha;

void main() {
    if (baseColorOf(inUv, vec4(1.0, 1.0, 1.0, inAlpha)).a < material.emission.w) discard;
}
