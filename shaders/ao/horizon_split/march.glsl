// Shared by horizons and normal rays: noise, directions around a normal, and positions of samples.
#ifndef OBSCURA_HORIZON_SPLIT_MARCH_GLSL
#define OBSCURA_HORIZON_SPLIT_MARCH_GLSL
#include "ao/common/lens.glsl"
#include "ao/common/tile.glsl"
#include "ao/horizon_split/constants.h"
#include "shared/falloff.h"
#include "shared/view.h"

layout(push_constant) uniform Block { HorizonSplitMarch constants; };

// Three permutations of 0..15 over a 4x4 tile. Values are (i + 0.5) / 16.
const float kRotation[16] = float[](0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5);
const float kStep[16] = float[](5, 13, 7, 15, 9, 1, 11, 3, 6, 14, 4, 12, 10, 2, 8, 0);
const float kNormal[16] = float[](9, 2, 12, 7, 4, 15, 1, 10, 14, 5, 11, 0, 3, 8, 6, 13);
// Increments of the noise of step and elevation from direction to direction, so that a pixel's lines sample at different distances.
const float kNextStep = 0.61803399, kNextNormal = 0.75487767;

struct Noise {  // each in [0,1)
    float rotation, step, normal;
};
Noise noiseAt(View view, ivec2 p) {
    int tile = (p.y & 3) * 4 + (p.x & 3);
    vec3 noise = constants.side > 1u ? pixelNoise(p) : (vec3(kRotation[tile], kStep[tile], kNormal[tile]) + 0.5) / 16.0;
    noise = fract(noise + frameShift(view));
    return Noise(noise.x, noise.y, noise.z);
}

// A pixel's share of the directions: their number, the first one, and the rotation from each to the next.
struct Share {
    uint count;
    vec2 first;
    mat2 next;
};
Share shareOfPixel(View view, ivec2 p, Noise noise, uint directions, uint side) {
    float turn = 6.28318531 / float(directions), first = (noise.rotation + (side > 1u ? float(shareOf(view, p, side)) : 0.0)) * turn;
    turn *= float(side * side);
    return Share(directions / (side * side), vec2(cos(first), sin(first)), mat2(cos(turn), sin(turn), -sin(turn), cos(turn)));
}

// Start of a pixel's lines and the basis of their directions.
struct Origin {
    vec3 position;  // raised by `offset` footprints of a pixel [Dimitrov, eq. 13; see horizon_split.cpp]
    vec3 n, b, c;   // normal and two tangents
};
Origin originAt(View view, ivec2 texel, float z, vec3 n, float offset) {
    vec3 p = eyePosition(view, vec2(texel) + 0.5, z);
    n = dot(n, towardsEye(view, p)) < 0.0 ? -n : n;
    float a = 1.0 / (1.0 + max(n.z, -0.999));  // [Frisvad 2012] for normals that face the camera
    float footprint = (view.orthographic > 0.5 ? 1.0 : z) / view.pixelsPerMetre;
    return Origin(
        p + n * (offset * footprint), n, vec3(1.0 - n.x * n.x * a, -n.x * n.y * a, -n.x), vec3(-n.x * n.y * a, 1.0 - n.y * n.y * a, -n.y));
}

// Positions of samples along a line: step j of N_s at the fraction t = (j + noise) / N_s.
struct Steps {
    uint count;
    float part;       // from step to step, 1 / N_s
    float radius, spacing;
    float thickness;  // of surfaces in the depth buffer, metres
};
Steps stepsOf(uint count, float radius, float spacing, float thickness) {
    return Steps(count, 1.0 / float(max(count, 1u)), radius, spacing, thickness);
}
float metresAt(Steps walk, float t) { return walk.radius * t * mix(1.0, t, walk.spacing); }

#ifdef BENT
#include "ao/common/bent_normals.glsl"
// What directions that miss the whole of the hemisphere take off the normal's part: with N tangents t,
//     2/3 n - 2/N sum of 1/3 (t + n) = -2/(3 N) sum of t
// A part o of the hemisphere that is blocked, times this, belongs to its mean direction (blockedBent()).
vec3 missed(vec3 tangents, float count) { return tangents * (-kWholeBent / count); }
#endif

// Texel of a word: H^2 of four directions, 8 bits each. Words of a pixel are side by side and below each other in one image; words per row:
// wordColumns() of horizon_split.cpp.
ivec2 wordAt(ivec2 p, uint word, uvec2 visible) {
    uint columns = visible.x > 8192u ? 1u : visible.y > 4096u ? 6u : 2u;
    return p + ivec2(uvec2(word % columns, word / columns) * visible);
}

#endif
