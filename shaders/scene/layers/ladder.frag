// Depth layers, ladder: the three nearest hits behind the visible surface, in one geometry pass. Each hit is inserted into a sorted list
// of three images by atomic maxima: where it replaces a farther hit, that one moves on to the next image. The result does not depend on
// the order of fragments. The depth test passes only fragments behind the visible surface. MASKED: alpha test.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant MASKED
#include "scene/face.glsl"
#include "scene/layers/hit.glsl"

layout(early_fragment_tests) in;
layout(set = 0, binding = 2, r32ui) uniform uimage2D second;
layout(set = 0, binding = 3, r32ui) uniform uimage2D third;
layout(set = 0, binding = 4, r32ui) uniform uimage2D fourth;

layout(location = 0) flat in float inShell;
#ifdef MASKED
#include "scene/material.glsl"
layout(location = 1) in vec4 inUv;
layout(location = 2) in float inAlpha;
#endif

void main() {
#ifdef MASKED
    if (baseColorOf(inUv, vec4(1.0, 1.0, 1.0, inAlpha)).a < material.emission.w) return;
#endif
    ivec2 p = ivec2(gl_FragCoord.xy);
    uint hit = hitOf(gl_FragCoord.z, faceOf(inShell));
    uint found = imageAtomicMax(second, p, hit);
    hit = found == hit ? 0u : min(hit, found);  // a duplicate is dropped
    if (hit != 0u) {
        found = imageAtomicMax(third, p, hit);
        hit = found == hit ? 0u : min(hit, found);
    }
    if (hit != 0u) imageAtomicMax(fourth, p, hit);
}
