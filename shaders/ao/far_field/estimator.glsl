// Obscurance estimator [Timonen 2013, sec. 4] in a plane through the receiver and the zenith Z, the direction to the camera. Points are
// added from near to far; one that raises the horizon blocks the arc that it gains. Angles are from the zenith, so a higher horizon has a
// smaller angle. The occluder of an arc is a line from the point: the slab away from the camera as in the paper, the connection to the
// previous point, or a blend. With phi = c - theta (c the line's direction, b its distance) the paper's four-dimensional table is exactly
//     integral of rho cos(theta - d) sin(theta) = 1/2 (sin(2c - d) dA1 - cos(2c - d) dA2 + sin(d) dA0)
// with differences of A0, A1, A2 (common/falloff_table.comp), two-dimensional. Include after declaring `table`, rgba32ui.
#ifndef OBSCURA_FAR_FIELD_ESTIMATOR_GLSL
#define OBSCURA_FAR_FIELD_ESTIMATOR_GLSL
#include "ao/common/falloff_table.glsl"

vec3 columnOf(uvec4 texel, float f) {
    vec2 a = unpackHalf2x16(texel.x), b = unpackHalf2x16(texel.y), c = unpackHalf2x16(texel.z);
    return vec3(mix(a.x, a.y, f), mix(b.x, b.y, f), mix(c.x, c.y, f));
}
// A(phi2, b) - A(phi1, b), both from the nearest row; rows are dense enough.
vec3 tableDifference(float phi1, float phi2, float v) {
    float column1 = phi1 * (float(kTableColumns - 1u) / kPi), column2 = phi2 * (float(kTableColumns - 1u) / kPi);
    int y = int(v * float(kTableRows - 1u) + 0.5), x1 = min(int(column1), int(kTableColumns) - 2),
        x2 = min(int(column2), int(kTableColumns) - 2);
    return columnOf(imageLoad(table, ivec2(x2, y)), column2 - float(x2)) - columnOf(imageLoad(table, ivec2(x1, y)), column1 - float(x1));
}

struct Horizon {
    float square;     // signed square of the cosine of its zenith angle, for comparisons without a root
    float angle;
    float connected;  // fraction of the connection in use: 0 until a point raises the horizon above the tangent plane, then up to 1
    float blocked;    // integral of the gained arcs, times |n_k|
};
const float kConnectionRate = 50.0;  // per radian of rise; gradual, so that points raised by rounding do not change the estimate
Horizon horizonAt(float cosine) { return Horizon(cosine * abs(cosine), arcCosine(cosine), 0.0, 0.0); }

// Whether a point in direction `to` (any length) from the receiver raises the horizon. Four points in five do not, so callers search with
// this for the next that does, then call raise(). Points beyond the zenith (u < 0) belong to other sectors.
bool raises(Horizon h, vec2 to) { return to.x > 0.0 && to.y * abs(to.y) > h.square * dot(to, to); }

// point: from the receiver; slab: direction away from the camera, any length; before: the previous point, visible or not; connection:
// weight of the line to it; all (u, z), along the sector and along the zenith. covered: share of the segment's width that the point stands
// for; the rest is sky, and the horizon rises by that share. n: the normal projected on this plane, not normalised.
// found: false if there was no such point; nothing changes then.
void raise(inout Horizon h, vec2 point, vec2 slab, vec2 before, float connection, float covered, bool found, vec2 n, float unit) {
    point.x = max(point.x, 1e-9);
    before -= point;
    float longer = sqrt(max(dot(slab, slab), 1e-30) / max(dot(before, before), 1e-30));
    // Weighted mean of two directions, at most as long as the slab.
    vec2 line = slab * (1.0 - connection * h.connected) + before * (connection * h.connected * longer);
    float inverse2 = 1.0 / max(dot(line, line), 1e-30), area = max(line.x * point.y - line.y * point.x, 0.0);
    float phi2 = arcTangent(area, dot(line, point)), angle = arcTangent(point.x, point.y), phi1 = max(phi2 - (h.angle - angle), 0.0);
    float b = area * sqrt(inverse2);
    vec3 a = tableDifference(min(phi1, phi2), phi2, b / (b + unit));
    vec2 twice = vec2(2.0 * line.x * line.y, line.y * line.y - line.x * line.x) * inverse2;  // sin 2c, cos 2c
    float gained = 0.5 * ((twice.x * n.y - twice.y * n.x) * a.y - (twice.y * n.y + twice.x * n.x) * a.z + n.x * a.x);
    h.blocked += found ? covered * gained : 0.0;
    h.square = found ? mix(h.square, point.y * abs(point.y) / dot(point, point), covered) : h.square;
    angle = mix(h.angle, angle, covered);
    h.connected = found ? min(h.connected + kConnectionRate * (h.angle - angle), 1.0) : h.connected;
    h.angle = found ? angle : h.angle;
}

#endif
