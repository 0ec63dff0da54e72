// Horizon-based ambient occlusion [Bavoil 2008]: one invocation a visible pixel, directions x steps nearest-texel samples.
// In: linear depth, packed normals (guard band included). Out: visibility, R16F. Formulas in runtime/ao/methods/hbao.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/tile.glsl"
#include "shared/falloff.h"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Constants {
    FalloffBlock falloffBlock;
    uint directions;
    uint steps;
    float bias;       // radians
    float maxPixels;  // longest reach, px
    float spacing;    // samples lie at mix(t, t^2, spacing) of the reach, t = (i + offset) / steps
    uint viewAxis;    // elevations over the plane across 0: the camera's axis, as the paper; 1: the pixel's own view ray
    uint sampleTest;  // 1: a sample counts only when it stands above the tangent plane by the bias itself
    uint side;        // of the tile whose pixels share out the directions; 1: each does all
};

const float kTwoPi = 6.28318531;

// Two permutations of 0..15 over a 4x4 tile: rotation and step offset, (i + 0.5) / 16.
const float kRotation[16] = float[](0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5);
const float kOffset[16] = float[](5, 13, 7, 15, 9, 1, 11, 3, 6, 14, 4, 12, 10, 2, 8, 0);

// Sine of the elevation, above the plane across the view direction, of the tangent plane towards the next pixel: where
// that pixel's view ray meets the plane.
float tangentSine(View view, vec3 here, vec3 n, vec3 v, vec2 pixel, vec2 direction) {
    vec3 ahead = eyePosition(view, pixel + direction, -here.z);
    vec3 t;
    if (view.orthographic > 0.5) {
        vec3 d = ahead - here;
        t = d - vec3(0, 0, 1) * dot(n, d) / max(n.z, 1e-3);
    } else {
        float facing = dot(n, ahead);
        t = abs(facing) > 1e-6 ? ahead * (dot(n, here) / facing) - here : ahead;
        if (facing * dot(n, here) <= 0.0) t = -v;  // the ray never meets the plane: it falls away behind the horizon
    }
    return dot(t, v) * inversesqrt(max(dot(t, t), 1e-20));
}

void main() {
    // Copies, so that the loops hold them in registers.
    View view = viewBlock;
    FalloffBlock rho = falloffBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 texel = p + ivec2(view.guard);
    float z = imageLoad(depth, texel).x;
    if (isSky(view, z)) {
        imageStore(visibility, p, vec4(1.0));
        return;
    }
    vec2 pixel = vec2(texel) + 0.5;
    vec3 here = eyePosition(view, pixel, z);
    vec3 n = unpackNormal(imageLoad(normals, texel).x);
    vec3 toEye = towardsEye(view, here);
    if (dot(n, toEye) < 0.0) n = -n;
    vec3 v = viewAxis != 0u ? toEye : vec3(0, 0, 1);
    float cosBias = cos(bias), sinBias = sin(bias);
    float leastRise = sampleTest != 0u ? sinBias : -1.0;

    float reach = min(rho.reach * view.pixelsPerMetre / (view.orthographic > 0.5 ? 1.0 : z), maxPixels);
    int tile = (texel.y & 3) * 4 + (texel.x & 3);
    vec3 shift = frameShift(view);
    vec2 noise = side > 1u ? pixelNoise(p).xy : (vec2(kRotation[tile], kOffset[tile]) + 0.5) / 16.0;
    float rotation = fract(noise.x + shift.x);
    float offset = fract(noise.y + shift.y);
    float stepPixels = max(reach / float(steps), 1.0);
    float span = stepPixels * float(steps);
    float inverseSteps = 1.0 / float(steps);
    ivec2 last = ivec2(view.size) - 1;
    vec2 size = vec2(view.size);

    float blocked = 0.0;
    uint shares = side * side;
    for (uint k = side > 1u ? shareOf(view, p, side) : 0u; k < directions; k += shares) {
        float angle = (float(k) + rotation) * kTwoPi / float(directions);
        vec2 direction = vec2(cos(angle), sin(angle));
        float tangent = tangentSine(view, here, n, v, pixel, direction);
        // sin(t + bias)
        float horizon = min(tangent * cosBias + sqrt(max(1.0 - tangent * tangent, 0.0)) * sinBias, 1.0);
        for (uint i = 0u; i < steps; ++i) {
            float t = (float(i) + offset) * inverseSteps;
            vec2 at = pixel + direction * max(mix(t, t * t, spacing) * span, 1.0);
            ivec2 q = clamp(ivec2(at), ivec2(0), last);
            vec3 d = eyePosition(view, vec2(q) + 0.5, imageLoad(depth, q).x) - here;
            float distance2 = dot(d, d);
            float inverse = inversesqrt(max(distance2, 1e-20));
            float sine = dot(d, v) * inverse;
            bool inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, size));
            float gain = inside && dot(d, n) * inverse >= leastRise ? max(sine - horizon, 0.0) : 0.0;
            blocked += falloff(rho, distance2 * inverse) * gain;
            horizon += gain;
        }
    }
    imageStore(visibility, p, vec4(clamp(1.0 - blocked / float(directions / shares), 0.0, 1.0)));
}
