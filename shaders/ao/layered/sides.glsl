// One side of a slice: view rays across it, what spans of matter cover of it, and how much that counts.
#ifndef OBSCURA_SIDES_GLSL
#define OBSCURA_SIDES_GLSL
#include "ao/common/spans.glsl"
#include "shared/falloff.h"

const float kPi = 3.14159265;

// The view ray of a place on the slice: points are offset + (F - D) dir from the pixel's own, F their depth and D the pixel's.
struct Ray {
    vec2 offset;
    vec3 dir;
    float v0, v1;      // dot(offset, v), dot(dir, v)
    float d0, d1, d2;  // squared distance: d0 + 2 d1 (F-D) + d2 (F-D)^2
};
struct Pixel {
    vec2 ray;       // eye.xy / depth, or nothing when orthographic
    float scale;    // metres of a difference of rays: depth, or 1
    float perspective;
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
// Distance to a span: to its nearest point, or to its front.
float distanceTo(Ray r, float f, float end) { return sqrt(max(square(r, clamp(-r.d1 / r.d2, f, end)), 0.0)); }

// One side of a slice. All integrals are told as parts of the whole side's.
struct Side {
    float least, flat_, curved;  // cosine at the hemisphere's end; up to cosine c: flat (1 - c^2) + curved (pi/2 - wave(c)), in 32nds
    uint covered;
    float blocked;               // 32nds
    vec3 before, faced;          // the last sample, from the pixel, and its normal
    float at, reached;           // pixels: where it lies, how far its surface was followed
};
// asin c + c sqrt(1 - c^2), to 0.0014.
float wave(float c) {
    float c2 = c * c;
    return c * (2.0109840 + c2 * (-0.4395425 + c2 * (0.2109025 - 0.2115477 * c2)));
}
float bitAt(Side side, float c) {
    c = max(c, side.least);
    return clamp(side.flat_ * (1.0 - c * c) + side.curved * (0.5 * kPi - wave(c)), 0.0, 32.0);
}
void cover(inout Side side, float front, float back, float weight) {
    uint bits = partsBetween(bitAt(side, front), bitAt(side, back)) & ~side.covered;
    side.covered |= bits;
    side.blocked += weight * float(bitCount(bits));
}

// Parts of equal weight lie evenly in the inverse of the distance, as seen from a plane's foot: the falloff of a stretch of surface is
// that at the harmonic mean of its ends. Their mean falloff instead makes long strata too bright.
float between(float a, float b) { return 2.0 * a * b / max(a + b, 1e-20); }

// A span over the stratum from e0 by l to e1: front at depth differences f0, f, f1, `size` long at l. A solid's back stays at its
// depth, for solids are round, unless that would halve it; a sheet's follows its front. `nearest`: distance that it comes to before l,
// where e0 lies behind something else. `least`: how long a solid counts at least as cover.
void span(inout Side side, FalloffBlock rho, Ray e0, Ray l, Ray e1, float f0, float f, float f1, float size, float nearest, float least, bool counts) {
    bool solid = size > 0.0;
    float b = f + abs(size), b0 = solid ? max(f0 + 0.5 * size, b) : f0 - size, b1 = solid ? max(f1 + 0.5 * size, b) : f1 - size;
    float d = distanceTo(l, f, solid ? b : f), d0 = min(distanceTo(e0, f0, solid ? b0 : f0), min(d, nearest)), d1 = distanceTo(e1, f1, solid ? b1 : f1);
    float w0 = falloff(rho, between(d, d0)), w1 = falloff(rho, between(d, d1));
    float more = solid ? max(least - size, 0.0) : 0.0;
    float front = cosine(l, f), back = cosine(l, b + more);
    cover(side, counts ? max(front, cosine(e0, f0)) : 1.0, counts ? min(back, cosine(e0, b0 + more)) : 1.0, w0);
    cover(side, counts ? max(front, cosine(e1, f1)) : 1.0, counts ? min(back, cosine(e1, b1 + more)) : 1.0, w1);
}

#endif
