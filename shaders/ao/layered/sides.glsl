// One side of a slice, and how a sample covers its integral. In the slice's plane the receiver is the origin, a is the coordinate along v
// towards the eye, b the one along the slice's direction across it; metres.
#ifndef OBSCURA_SIDES_GLSL
#define OBSCURA_SIDES_GLSL
#ifdef BENT
#include "ao/common/bent_normals.glsl"
#endif
#include "ao/common/packed_layers.glsl"
#include "shared/falloff.h"
#include "shared/view.h"

const float kPi = 3.14159265;
const float kAbove = 0.002;   // least sine of a sample above the tangent plane
const float kPlate = 0.65;    // part of its stratum that a sample stands for, to each end

const float kOffSlice = 0.7;  // px, most that the centre of a sample's pixel is off the slice
const float kJoin = 1.0;      // least change of depth per metre across up to which a sample and the one before are on one surface

// The pixel as its samples see it. A sample d pixels away, with depth F, is at F (d.x, d.y, 0) + (F - D) ray from a receiver of depth D, in
// units of unproject; so dot products with v, od and n are linear in d, F and F - D.
struct Receiver {
    vec2 v, od, n;      // per pixel
    float rayV, rayN;   // of the receiver's view ray, per metre of depth
    float inverseV;     // depth per metre towards the eye
    float perspective;  // 1, or 0 if orthographic
    float depth;
    float perPixel;     // metres across the view of a pixel of the slice, per metre of depth
};
Receiver receiverOf(View view, vec2 pixel, float depth, vec3 v, vec3 n, vec3 od, vec2 step) {
    Receiver r;
    r.perspective = view.orthographic > 0.5 ? 0.0 : 1.0;
    vec3 ray = vec3((pixel * view.unproject.xy + view.unproject.zw) * r.perspective, -1.0);
    r.v = v.xy * view.unproject.xy;
    r.od = od.xy * view.unproject.xy;
    r.n = n.xy * view.unproject.xy;
    r.rayV = dot(ray, v);
    r.rayN = dot(ray, n);
    r.inverseV = -1.0 / r.rayV;
    r.depth = depth;
    r.perPixel = length(step * view.unproject.xy);
    return r;
}
struct Aside {
    float v, od, n;  // of a sample's distance in the image, per metre of depth
};
Aside asideOf(Receiver r, vec2 pixels, float sign) { return Aside(dot(pixels, r.v), sign * dot(pixels, r.od), dot(pixels, r.n)); }

// A sample's distance in the image, and the squared factors on b at the ends of the plate that it stands for. l, start, end: of the sample
// and its stratum, px.
struct Plate {
    float at, inner, outer;
};
Plate plateOf(float l, float start, float end) {
    float inner = mix(1.0, min(start / l, 1.0), kPlate), outer = mix(1.0, max(end / l, 1.0), kPlate);
    return Plate(l, inner * inner, outer * outer);
}

// Integrals are in 32nds of the side's. The integral up to cosine c is full - squareWeight c^2 - arcWeight c arcFactor(c^2).
struct Side {
    float squareWeight, arcWeight, full;
    float least;     // cosine at the hemisphere's edge
    uint covered;    // a bit for each 32nd
    float blocked;   // 32nds
    float f, at;     // of the sample before: depth relative to the receiver, distance in the image, px; at first, of the receiver
    float place;     // of its front, 32nds
    float distance;  // metres
#ifdef BENT
    vec2 normal, bent;  // (nv, no); mean direction of what is blocked times 32nds, along v and towards the side
    float cosine;       // of the front of the sample before
#endif
};
Side sideOf(float nv, float no, float least, float whole) {
    float scale = 16.0 / max(whole, 1e-6);
    return Side(nv * scale, no * scale, (nv + 0.5 * kPi * no) * scale, least, 0u, 0.0, 0.0, 0.0, 32.0, 0.0
#ifdef BENT
        , vec2(nv, no), vec2(0.0), least
#endif
    );
}
// (asin c + c sqrt(1 - c^2)) / c, to 0.006.
float arcFactor(float c2) { return 1.98877 + c2 * (-0.27345 - 0.13895 * c2); }
float placeOf(Side side, float a, float b2) {
    float c = max(a * inversesqrt(max(a * a + b2, 1e-20)), side.least), c2 = c * c;
    return side.full - side.squareWeight * c2 - side.arcWeight * c * arcFactor(c2);
}

#ifdef BENT
float cosineOf(Side side, float a, float b2) { return max(a * inversesqrt(max(a * a + b2, 1e-20)), side.least); }
#endif

// Covers what a layer of a sample hides: the plate from its front to its back and, if the sample before can be on the same surface, the gap
// between them. f: depth relative to the receiver. first: the layer nearest the eye.
void cover(inout Side side, Receiver r, FalloffBlock rho, Plate plate, Aside aside, float depth, float f, float size, float steepest,
    bool counts, bool first) {
    float metres = r.perspective > 0.5 ? depth : 1.0, towardsV = aside.v * r.perspective + r.rayV, towardsOd = aside.od * r.perspective;
    float a = aside.v * metres + f * r.rayV, b = aside.od * metres, height = aside.n * metres + f * r.rayN;
    float backA = a + abs(size) * towardsV, backB = b + abs(size) * towardsOd;
    float from = placeOf(side, a, (a > 0.0 ? plate.inner : plate.outer) * b * b),
          to = placeOf(side, backA, (backA > 0.0 ? plate.outer : plate.inner) * backB * backB);
#ifdef BENT
    float fromCosine = cosineOf(side, a, (a > 0.0 ? plate.inner : plate.outer) * b * b),
          toCosine = cosineOf(side, backA, (backA > 0.0 ? plate.outer : plate.inner) * backB * backB);
#endif
    float nearest = clamp(a * r.inverseV, 0.0, max(size, 0.0));  // a receiver behind a solid faces its back
    float nearA = a + nearest * towardsV, nearB = b + nearest * towardsOd, distance = sqrt(nearA * nearA + nearB * nearB);
    if (first) {
        float across = (plate.at - side.at + kOffSlice) * r.perPixel * (r.perspective > 0.5 ? r.depth + side.f : 1.0);
        bool joined = abs(f - side.f) < max(steepest, kJoin) * across;
        Side before = side;
        side.f = f;
        side.at = plate.at;
        side.place = from;
        side.distance = distance;
        from = joined ? min(from, before.place) : from;
        to = joined ? max(to, before.place) : to;
        distance = joined ? 0.5 * (distance + before.distance) : distance;
#ifdef BENT
        side.cosine = fromCosine;
        fromCosine = joined ? max(fromCosine, before.cosine) : fromCosine;
        toCosine = joined ? min(toCosine, before.cosine) : toCosine;
#endif
    }
    bool above = height > kAbove * (abs(a) + abs(b));  // samples in the tangent plane cover nothing
    uint bits = counts && above ? bitsBetween(from, min(to, 32.0)) & ~side.covered : 0u;
    side.covered |= bits;
    side.blocked += falloff(rho, distance) * float(bitCount(bits));
#ifdef BENT
    vec2 mean = meanBent(side.normal.x, side.normal.y, fromCosine, min(toCosine, fromCosine));
    side.bent += falloff(rho, distance) * float(bitCount(bits)) * mean;
#endif
}

#endif
