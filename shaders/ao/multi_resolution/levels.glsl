// Shared by the passes over levels. Texels of level i are 2^(i-1) px wide; all levels start at the upper left of the buffers. Depth and
// normals cover a whole level, obscurance an area: the visible part and the margin that filters read.
#ifndef OBSCURA_MULTI_RESOLUTION_LEVELS_GLSL
#define OBSCURA_MULTI_RESOLUTION_LEVELS_GLSL
#include "shared/octahedral.glsl"
#include "shared/view.h"

// false: obscurance is a scalar, as in the paper. true: a vector towards the occluders, whose component along the normal is that scalar.
// Fine levels evaluate the vectors of coarse ones along their own normals.
layout(constant_id = 0) const bool kDirected = false;

struct Surface {
    vec3 position, n;  // n faces the camera
};
Surface surfaceOf(View view, vec2 pixel, float z, uint normal) {
    Surface s = Surface(eyePosition(view, pixel, z), unpackNormal(normal));
    s.n = dot(s.n, towardsEye(view, s.position)) < 0.0 ? -s.n : s.n;
    return s;
}

// Obscurance of a level and all coarser ones [Hoang and Low 2012, eq. 10]: the largest mean of a level, the sum over all samples, and their
// number. Not directed: in x only.
struct Obscurance {
    vec3 most, sum;
    float count;
};
void gather(inout Obscurance o, float w, Obscurance other) {
    o.most += w * other.most;
    o.sum += w * other.sum;
    o.count += w * other.count;
}
float along(vec3 v, vec3 n) { return kDirected ? max(dot(v, n), 0.0) : v.x; }

const float kLowest = 0.05;  // least sine of a direction's elevation; packed directions are too coarse for less

// Packs 32 bits: 11 of the largest mean, 11 of the mean over all samples, 10 of their number in steps of 1/2; directions in another 32.
// Both values are components along the texel's normal, so the coarse directions cause no error where the normal does not change.
uvec2 packed(Obscurance o, vec3 n) {
    vec2 shares = clamp(vec2(along(o.most, n), o.count > 0.0 ? along(o.sum, n) / o.count : 0.0), 0.0, 1.0);
    uint numbers = uint(shares.x * 2047.0 + 0.5) | uint(shares.y * 2047.0 + 0.5) << 11 | uint(min(o.count * 2.0 + 0.5, 1023.0)) << 22;
    if (!kDirected) return uvec2(numbers, 0u);
    vec3 most = shares.x > 0.0 ? o.most : n, sum = shares.y > 0.0 ? o.sum : n;
    return uvec2(numbers, packSnorm4x8(vec4(toOctahedron(most), toOctahedron(sum))));
}
// For the texel's own normal; directions are not needed.
Obscurance unpackedOwn(uint bits, vec3 n) {
    float count = float(bits >> 22) * 0.5;
    vec3 unit = kDirected ? n : vec3(1, 0, 0);
    return Obscurance(float(bits & 2047u) / 2047.0 * unit, float(bits >> 11 & 2047u) / 2047.0 * count * unit, count);
}
Obscurance unpacked(uvec2 bits, vec3 n) {
    Obscurance o = unpackedOwn(bits.x, n);
    if (!kDirected) return o;
    vec4 e = unpackSnorm4x8(bits.y);
    vec3 most = fromOctahedron(e.xy), sum = fromOctahedron(e.zw);
    o.most = dot(o.most, n) / max(dot(most, n), kLowest) * most;
    o.sum = dot(o.sum, n) / max(dot(sum, n), kLowest) * sum;
    return o;
}

// Bilateral weight of two texels [eq. 8, 9]: t_n = 8, t_z = 16. Their distance, in tolerances (1 m in the paper), is measured along the
// view axis as in the paper or, with `planes`, from the first texel's tangent plane.
float alike(Surface here, Surface there, float perTolerance, uint planes) {
    float facing = dot(here.n, there.n) * 0.5 + 0.5;
    facing *= facing;
    facing *= facing;
    vec3 v = there.position - here.position;
    float near = 1.0 / (1.0 + perTolerance * abs(planes != 0u ? dot(v, here.n) : v.z));
    near *= near;
    near *= near;
    near *= near;
    return facing * facing * near * near;
}

#endif
