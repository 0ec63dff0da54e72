// One side of a slice: its view rays, and coverage of its integral by depth layers.
#ifndef OBSCURA_SIDES_GLSL
#define OBSCURA_SIDES_GLSL
#include "ao/common/packed_layers.glsl"
#include "shared/falloff.h"

const float kPi = 3.14159265;

// View ray at a place on the slice. Points relative to the pixel's position: offset + (F - D) dir, F their depth and D the pixel's.
struct Ray {
    vec2 offset;
    vec3 dir;
    float v0, v1;      // dot(offset, v), dot(dir, v)
    float d0, d1, d2;  // squared distance: d0 + 2 d1 (F-D) + d2 (F-D)^2
};
struct Pixel {
    vec2 ray;       // eye.xy / depth; orthographic: eye.xy
    float scale;    // metres per unit of a difference of rays: depth, or 1 if orthographic
    float perspective;  // 1, or 0 if orthographic
    float depth;
    vec3 n, v;
};

Ray rayAt(Pixel here, vec2 aside) {  // aside: difference of rays
    Ray r;
    r.offset = aside * here.scale;
    r.dir = vec3((here.ray + aside) * here.perspective, -1.0);
    r.v0 = dot(r.offset, here.v.xy);
    r.v1 = dot(r.dir, here.v);
    r.d0 = dot(r.offset, r.offset);
    r.d1 = dot(r.offset, r.dir.xy);
    r.d2 = dot(r.dir, r.dir);
    return r;
}
float square(Ray r, float f) { return r.d0 + f * (2.0 * r.d1 + f * r.d2); }
// Cosine of the angle at the pixel between the eye and a point.
float cosine(Ray r, float f) { return (r.v0 + f * r.v1) * inversesqrt(max(square(r, f), 1e-20)); }
// Distance to the nearest point of a ray between depth differences f and end.
float distanceTo(Ray r, float f, float end) { return sqrt(max(square(r, clamp(-r.d1 / r.d2, f, end)), 0.0)); }

// One side of a slice. Integrals are in 32nds of the whole side's. The integral up to cosine c is
// squareWeight (1 - c^2) + arcWeight (pi/2 - arcTerm(c)).
struct Side {
    float least, squareWeight, arcWeight;  // least: cosine at the hemisphere's edge
    uint covered;
    float blocked;                         // 32nds
    vec3 previous, previousNormal;         // the previous sample, from the pixel, and its normal
    float previousAt, previousEnd;         // px: its distance, and the end to which its surface was extended
};
// asin c + c sqrt(1 - c^2), to 0.0014.
float arcTerm(float c) {
    float c2 = c * c;
    return c * (2.0109840 + c2 * (-0.4395425 + c2 * (0.2109025 - 0.2115477 * c2)));
}
float bitAt(Side side, float c) {
    c = max(c, side.least);
    return clamp(side.squareWeight * (1.0 - c * c) + side.arcWeight * (0.5 * kPi - arcTerm(c)), 0.0, 32.0);
}
void cover(inout Side side, float front, float back, float weight) {
    uint bits = bitsBetween(bitAt(side, front), bitAt(side, back)) & ~side.covered;
    side.covered |= bits;
    side.blocked += weight * float(bitCount(bits));
}

// Harmonic mean of the distances of a segment's ends, where its falloff is evaluated: equal weights are evenly spaced in 1 / distance along
// a plane. The mean of the two falloffs instead makes long strata too bright.
float harmonicMean(float a, float b) { return 2.0 * a * b / max(a + b, 1e-20); }

// Covers the segment of a layer over the stratum from ray e0 through l to e1. Its front is at depth differences f0, f, f1; size: its packed
// length at l. The back of a solid keeps its depth, as for round objects, unless that halves the length; the back of a sheet is parallel to
// its front. nearest: upper bound of the distance at e0. least: least length of a solid when it covers.
void coverLayer(inout Side side, FalloffBlock rho, Ray e0, Ray l, Ray e1, float f0, float f, float f1, float size, float nearest,
    float least, bool counts) {
    bool solid = size > 0.0;
    float b = f + abs(size), b0 = solid ? max(f0 + 0.5 * size, b) : f0 - size, b1 = solid ? max(f1 + 0.5 * size, b) : f1 - size;
    float d = distanceTo(l, f, solid ? b : f), d0 = min(distanceTo(e0, f0, solid ? b0 : f0), min(d, nearest)),
          d1 = distanceTo(e1, f1, solid ? b1 : f1);
    float w0 = falloff(rho, harmonicMean(d, d0)), w1 = falloff(rho, harmonicMean(d, d1));
    float more = solid ? max(least - size, 0.0) : 0.0;
    float front = cosine(l, f), back = cosine(l, b + more);
    cover(side, counts ? max(front, cosine(e0, f0)) : 1.0, counts ? min(back, cosine(e0, b0 + more)) : 1.0, w0);
    cover(side, counts ? max(front, cosine(e1, f1)) : 1.0, counts ? min(back, cosine(e1, b1 + more)) : 1.0, w1);
}

#endif
