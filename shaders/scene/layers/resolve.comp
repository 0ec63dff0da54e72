// Hits in order -> depth layers, by a rule that open, nested and badly wound meshes need: what begins at a front face ends at
// the next hit when that is a back face; when another solid begins before, at the next hit of its own if that is a back face.
// Else, or where the first hit is no front face, it is a sheet without thickness, and the next layer starts at the next hit.
// Units and codes: obscura/ao.h, DepthLayers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/frame.h"
#include "scene/layers/hit.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform FrameUniform { SceneFrame frame; };
layout(set = 0, binding = 1) uniform sampler2D depthMap;
layout(set = 0, binding = 2) uniform sampler2D materialMap;  // a: face of the visible hit
layout(set = 0, binding = 3) uniform usampler2D secondHits;
layout(set = 0, binding = 4) uniform usampler2D thirdHits;
layout(set = 0, binding = 5) uniform usampler2D fourthHits;
layout(set = 0, binding = 6, r16f) uniform writeonly image2D thickness;
layout(set = 0, binding = 7, rg32f) uniform writeonly image2D second;
layout(push_constant) uniform Constants {
    uint hits;     // behind the visible one: 1 or 3
    uint asked;    // 0: no second layer; 1: of every pixel; 2: of every other one
};

const float kEndless = 65504.0, kThinnest = 1e-4;  // of solids, metres: 0 would be a sheet
const float kTouching = 1e-4;  // of the depth: what begins so little before a solid ends stands at it, not in it

// The first four hits, `count` of them there.
float z[4];
uint face[4];
int count = 1;

uint sideOf(int i) { return face[i] & 3u; }
// The hit at which what begins at hit i ends; 0: none, it is a sheet.
int endOf(int i) {
    if (sideOf(i) != kFront || i + 1 >= count) return 0;
    if (sideOf(i + 1) == kBack) return i + 1;
    for (int k = i + 1; k < count; ++k)
        if (face[k] >> 2 == face[i] >> 2) return sideOf(k) == kBack ? k : 0;
    return 0;
}

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(thickness)))) return;
    float d = texelFetch(depthMap, p, 0).x;
    z[0] = linearDepth(frame.projection, d);
    face[0] = uint(texelFetch(materialMap, p, 0).a * 255.0 + 0.5);
    uint behind[3];
    behind[0] = texelFetch(secondHits, p, 0).x;
    behind[1] = hits > 1u ? texelFetch(thirdHits, p, 0).x : 0u;
    behind[2] = hits > 1u ? texelFetch(fourthHits, p, 0).x : 0u;
    for (int i = 0; i < 3; ++i) {
        if (behind[i] == 0u) break;
        z[count] = linearDepth(frame.projection, depthOf(behind[i]));
        face[count++] = faceOfHit(behind[i]);
    }
    int end = endOf(0), next = end + 1;
    for (int k = end - 1; k > 0; --k)
        if (z[k] > z[end] * (1.0 - kTouching)) next = k;
    imageStore(thickness, p, vec4(d <= 0.0 ? kEndless : end > 0 ? clamp(z[end] - z[0], kThinnest, kEndless) : 0.0));

    if (asked == 0u || (asked == 2u && ((p.x | p.y) & 1) != 0)) return;
    vec2 result = vec2(0.0);
    if (next < count) {
        int last = endOf(next);
        result = vec2(z[next], last > 0 ? max(z[last] - z[next], kThinnest) : 0.0);
    }
    imageStore(second, asked == 2u ? p >> 1 : p, vec4(result, 0.0, 0.0));
}
