// The obscurance estimator [Timonen 2013, sec. 4] in a plane through the receiver and the zenith Z, the direction to the camera: points come in
// from near to far, each that raises the horizon blocks the arc it gains. Angles are from the zenith, so a higher horizon is a smaller one.
// What blocks an arc is a line from the point: the slab away from the camera as in the paper, the connection to the point before it, or
// something between. With phi = c - theta (c the line's direction, b its distance) the paper's four-dimensional table is exactly
//     integral of rho cos(theta - d) sin(theta) = 1/2 (sin(2c - d) dA1 - cos(2c - d) dA2 + sin(d) dA0)
// with differences of A0, A1, A2 (table.comp), two-dimensional. Include after declaring `table`, rgba32ui.
#ifndef OBSCURA_FAR_FIELD_ESTIMATOR_GLSL
#define OBSCURA_FAR_FIELD_ESTIMATOR_GLSL
#include "ao/far_field/table.glsl"

vec3 columnOf(uvec4 texel, float f) {
    vec2 a = unpackHalf2x16(texel.x), b = unpackHalf2x16(texel.y), c = unpackHalf2x16(texel.z);
    return vec3(mix(a.x, a.y, f), mix(b.x, b.y, f), mix(c.x, c.y, f));
}
// A(phi2, b) - A(phi1, b). The nearest row: they are dense enough, and both angles take the same.
vec3 tableDifference(float phi1, float phi2, float v) {
    float column1 = phi1 * (float(kTableColumns - 1u) / kPi), column2 = phi2 * (float(kTableColumns - 1u) / kPi);
    int y = int(v * float(kTableRows - 1u) + 0.5), x1 = min(int(column1), int(kTableColumns) - 2), x2 = min(int(column2), int(kTableColumns) - 2);
    return columnOf(imageLoad(table, ivec2(x2, y)), column2 - float(x2)) - columnOf(imageLoad(table, ivec2(x1, y)), column1 - float(x1));
}

struct Horizon {
    float square;   // the cosine of its zenith angle, squared, with its sign: tells without a root what raises it
    float angle;
    float follows;  // 1, connection, once a point has raised it well above the tangent plane
    float blocked;  // what was gained, times |n_k|
};
const float kFollows = 50.0;  // per radian of that: had the first visible point no part in it, one that rounding lifts would change what follows
Horizon horizonAt(float cosine) { return Horizon(cosine * abs(cosine), arcCosine(cosine), 0.0, 0.0); }

// Whether a point in direction `to` (any length) from the receiver raises the horizon. Four points in five do not, and they are told by this
// alone: walkers search for the next that does, then raise(). What lies beyond the zenith (u < 0) belongs to other sectors.
bool raises(Horizon h, vec2 to) { return to.x > 0.0 && to.y * abs(to.y) > h.square * dot(to, to); }

// `point` from the receiver, `slab` away from the camera (any length), `before` the point looked at before it, visible or not, and how much of
// the line leads there; all (u, z): along the sector and along the zenith. n: the normal projected on this plane, not normalised.
// `found` false: there was no such point.
void raise(inout Horizon h, vec2 point, vec2 slab, vec2 before, float connection, bool found, vec2 n, float unit) {
    point.x = max(point.x, 1e-9);
    before -= point;
    float longer = sqrt(max(dot(slab, slab), 1e-30) / max(dot(before, before), 1e-30));
    vec2 line = slab * (1.0 - connection * h.follows) + before * (connection * h.follows * longer);  // the mean of two directions, as long as the slab or shorter
    float inverse2 = 1.0 / max(dot(line, line), 1e-30), area = max(line.x * point.y - line.y * point.x, 0.0);
    float phi2 = arcTangent(area, dot(line, point)), angle = arcTangent(point.x, point.y), phi1 = max(phi2 - (h.angle - angle), 0.0);
    float b = area * sqrt(inverse2);
    vec3 a = tableDifference(min(phi1, phi2), phi2, b / (b + unit));
    vec2 twice = vec2(2.0 * line.x * line.y, line.y * line.y - line.x * line.x) * inverse2;  // sin 2c, cos 2c
    float gained = 0.5 * ((twice.x * n.y - twice.y * n.x) * a.y - (twice.y * n.y + twice.x * n.x) * a.z + n.x * a.x);
    h.blocked += found ? gained : 0.0;
    h.square = found ? point.y * abs(point.y) / dot(point, point) : h.square;
    h.follows = found ? min(h.follows + kFollows * (h.angle - angle), 1.0) : h.follows;
    h.angle = found ? angle : h.angle;
}

#endif
