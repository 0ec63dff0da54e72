// Receivers, and the plane of one segment of a sector through a receiver. A point of depth D, r pixels along the direction from the
// receiver, is in that plane at
//     u = scale(D) r du,   z = D (z0 + r dz)
// relative to the camera, for depths from scans, the near field or a mipmap.
#ifndef OBSCURA_FAR_FIELD_RECEIVER_GLSL
#define OBSCURA_FAR_FIELD_RECEIVER_GLSL
#include "ao/common/falloff_table.glsl"
#include "shared/view.h"

struct Receiver {
    vec3 p;        // raised above the surface by a pixel's longer side, so that slanted planes do not shadow themselves
    vec2 pixel;    // projection of p; samples start there
    vec3 n, zenith;
    float nz;      // n.zenith
    float z0;
    vec2 scale;    // scale(D) = D * scale.x + scale.y
    vec2 unproject, size;
    float area, trace;  // of a pixel projected onto the plane perpendicular to the zenith: its area, the sum of its sides' squares
};
Receiver receiverAt(View view, ivec2 texel, float depth, vec3 n) {
    vec2 scale = view.orthographic > 0.5 ? vec2(0, 1) : vec2(1, 0);
    vec3 p = eyePosition(view, vec2(texel) + 0.5, depth);
    n = dot(n, towardsEye(view, p)) < 0.0 ? -n : n;
    p += n * ((depth * scale.x + scale.y) * max(abs(view.unproject.x), abs(view.unproject.y)));
    vec3 zenith = towardsEye(view, p);
    float z0 = view.orthographic > 0.5 ? -1.0 : dot(p, zenith) / -p.z;
    vec2 sides2 = view.unproject.xy * view.unproject.xy;
    return Receiver(p, pixelOf(view, p), n, zenith, max(dot(n, zenith), 0.0), z0, scale, view.unproject.xy, vec2(view.size),
        abs(view.unproject.x * view.unproject.y) * zenith.z, dot(sides2, 1.0 - zenith.xy * zenith.xy));
}

struct Segment {
    vec2 along;        // step on the screen that is one pixel along the sector's direction
    float du, z0, dz;
    float origin;      // the receiver's z in the plane; its u is 0
    vec2 n;            // projected normal (u, z), not normalised
    float start;       // cosine of the zenith angle of the tangent plane
    float weight;      // angle around the zenith [eq. 2: w_k]
    float exit;        // pixels along the direction to the edge of the image
    vec2 scale;
};
// along * stretch, along of unit length, is a step of one pixel along the sector's direction. width: cosine and sine of half the segment's
// width.
Segment segmentOf(Receiver r, vec2 along, float stretch, vec2 width) {
    Segment s;
    vec2 g = along * r.unproject;
    float g2 = dot(g, g), perStep = inversesqrt(g2);
    vec2 e = g * perStep;
    float ez = dot(e, r.zenith.xy), sine2 = 1.0 - ez * ez, inverse = inversesqrt(sine2);
    s.along = along * stretch;
    s.origin = dot(r.p, r.zenith);
    s.z0 = r.z0;
    s.du = g2 * perStep * sine2 * inverse * stretch;
    s.dz = g2 * perStep * ez * stretch * r.scale.x;
    s.n = vec2((dot(r.n.xy, e) - ez * r.nz) * inverse, r.nz);
    s.start = -s.n.x * inversesqrt(max(dot(s.n, s.n), 1e-20));
    // Width in azimuth: the angle between the segment's two sides, (width.x, +-width.y) pixels along and across, projected onto the plane
    // perpendicular to the zenith. The squares of steps along and across, projected, add up to r.trace.
    s.weight = arcTangent(2.0 * width.x * width.y * r.area, g2 * sine2 - width.y * width.y * r.trace);
    vec2 space = mix(r.pixel, r.size - r.pixel, greaterThan(along, vec2(0.0))) / max(abs(along), vec2(1e-6));
    s.exit = min(space.x, space.y) / stretch;
    s.scale = r.scale;
    return s;
}
// Vector from the receiver to a point r pixels away: across = (depth * scale.x + scale.y) r, over = 1. The result is linear in across,
// depth and over, so `over` times all of them gives `over` times the vector, whose direction needs no division.
vec2 seenAt(Segment s, float across, float depth, float over) {
    return vec2(across * s.du, depth * s.z0 + across * s.dz - over * s.origin);
}
vec2 pointAt(Segment s, float depth, float r) { return seenAt(s, (depth * s.scale.x + s.scale.y) * r, depth, 1.0); }
// Direction away from the camera at such a point, not normalised.
vec2 slabAt(Segment s, vec2 point) { return vec2(point.x * s.scale.x, point.y + s.origin); }

#endif
