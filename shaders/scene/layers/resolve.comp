// Sorted hits to depth layers, tolerating open, nested and badly wound meshes. A layer that starts at a front face ends at the next hit if
// that is a back face; else at the next hit of the same solid, if that is a back face. Otherwise, or if it does not start at a front face,
// it is a sheet of thickness 0. The next layer starts at the next hit. Units and special values: obscura/ao.h, DepthLayers.
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
    uint hits;          // number of hits behind the visible one: 1 or 3
    uint secondLayer;   // 0: none; 1: at every pixel; 2: at every second pixel in x and y
};

const float kEndless = 65504.0, kThinnest = 1e-4;  // of solids, metres: 0 would be a sheet
const float kTouching = 1e-4;  // fraction of depth: a hit this close before a solid's end touches the solid from outside

// The first four hits; `count` are valid.
float z[4];
uint face[4];
int count = 1;

uint sideOf(int i) { return face[i] & 3u; }
// The hit where the layer that starts at hit i ends; 0: none, a sheet.
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

    if (secondLayer == 0u || (secondLayer == 2u && ((p.x | p.y) & 1) != 0)) return;
    vec2 result = vec2(0.0);
    if (next < count) {
        int last = endOf(next);
        result = vec2(z[next], last > 0 ? max(z[last] - z[next], kThinnest) : 0.0);
    }
    imageStore(second, secondLayer == 2u ? p >> 1 : p, vec4(result, 0.0, 0.0));
}
