// Geometric normals from linear depth. On each axis the side whose two texels extrapolate best to this pixel is taken to be on the same
// surface; the normal is the cross product of the two chosen differences.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View view; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform writeonly uimage2D normals;

float depthAt(ivec2 p) { return imageLoad(depth, clamp(p, ivec2(0), ivec2(view.size) - 1)).x; }
vec3 positionAt(ivec2 p) { p = clamp(p, ivec2(0), ivec2(view.size) - 1); return eyePosition(view, vec2(p) + 0.5, imageLoad(depth, p).x); }

// Planes are linear on the screen in 1/depth, orthographic in depth; extrapolate there.
float linearOf(float depth) { return view.orthographic > 0.5 ? depth : 1.0 / depth; }
float misfit(float centre, ivec2 p, ivec2 step) {
    return abs(2.0 * linearOf(depthAt(p + step)) - linearOf(depthAt(p + 2 * step)) - linearOf(centre));
}

vec3 difference(ivec2 p, vec3 here, float centre, ivec2 step) {
    bool hasBack = all(greaterThanEqual(p - step, ivec2(0)));
    bool hasAhead = all(lessThan(p + step, ivec2(view.size)));
    bool ahead = hasAhead && (!hasBack || misfit(centre, p, step) < misfit(centre, p, -step));
    if (!ahead && !hasBack) return vec3(step, 0.0);
    return ahead ? positionAt(p + step) - here : here - positionAt(p - step);
}

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.size)))) return;
    float centre = imageLoad(depth, p).x;
    vec3 n = vec3(0, 0, 1);
    if (!isSky(view, centre)) {
        vec3 here = positionAt(p);
        vec3 normal = cross(difference(p, here, centre, ivec2(1, 0)), difference(p, here, centre, ivec2(0, 1)));
        float size = dot(normal, normal);
        if (size > 0.0 && !isinf(size)) n = normal * inversesqrt(size);
        if (dot(n, towardsEye(view, here)) < 0.0) n = -n;
    }
    imageStore(normals, p, uvec4(packNormal(n)));
}
