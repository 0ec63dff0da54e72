// What things leave open of a segment. The background, and what stands on it without a gap, raises a horizon as ever (estimator.glsl); what floats
// above it covers parts of the arc between zenith and tangent plane, cut into 32 bins, so that what comes later counts by the share of its arc that is
// still open. Fractions of cover take some of the bins and not others: which is a matter of the interval alone, so pictures hold still.
#ifndef OBSCURA_FAR_FIELD_THINGS_MET_GLSL
#define OBSCURA_FAR_FIELD_THINGS_MET_GLSL
#include "ao/far_field/estimator.glsl"

struct Arc {
    vec2 high, low;     // to its two ends from the receiver, (u, z), any length,
    vec2 over;          // what to divide them by to have metres
    float opacity;
    bool is;
};
struct Open {
    Horizon horizon;
    uint covered;
    float perBin;       // bins per radian from the zenith
};
Open openAt(float cosine) { return Open(horizonAt(cosine), 0u, 32.0 / arcCosine(cosine)); }

float freeBelow(uint covered, float place) {
    int i = int(place);
    return float(bitCount(~covered & (i > 31 ? ~0u : (1u << i) - 1u))) + fract(place) * float((~covered >> min(i, 31)) & 1u);
}
// The open share of the arc from one zenith angle to another.
float openBetween(Open open, float from, float to) {
    vec2 place = clamp(vec2(from, to) * open.perBin, 0.0, 32.0);
    return clamp((freeBelow(open.covered, place.y) - freeBelow(open.covered, place.x)) / max(place.y - place.x, 1e-3), 0.0, 1.0);
}

// So many eighths of all bins, evenly spread, and from where they are counted.
uint someOf(float share, uint seed) {
    uint eighths = uint(share * 8.0 + float(seed >> 24) * (1.0 / 256.0)), by = 1u + (seed & 7u);
    uint pattern = (((eighths < 4u ? 0x49110100u : 0x7f776d55u) >> (8u * (eighths & 3u))) & 255u) * 0x01010101u;
    return eighths > 7u ? ~0u : pattern << by | pattern >> (32u - by);
}

void cover(inout Open open, Arc arc, vec2 n, float unit, uint seed) {
    vec2 high = arc.high / arc.over.x, low = arc.low / arc.over.y;
    high.x = max(high.x, 1e-9);
    low.x = max(low.x, 1e-9);
    float top = arcTangent(high.x, high.y), bottom = arcTangent(low.x, low.y), end = min(bottom, open.horizon.angle);
    bool is = arc.is && end > top;
    vec2 line = low - high;
    float inverse2 = 1.0 / max(dot(line, line), 1e-30), area = max(line.x * high.y - line.y * high.x, 0.0);
    float phi2 = arcTangent(area, dot(line, high)), phi1 = max(phi2 - (end - top), 0.0), b = area * sqrt(inverse2);
    vec3 a = tableDifference(min(phi1, phi2), phi2, b / (b + unit));
    vec2 twice = vec2(2.0 * line.x * line.y, line.y * line.y - line.x * line.x) * inverse2;
    float gained = 0.5 * ((twice.x * n.y - twice.y * n.x) * a.y - (twice.y * n.y + twice.x * n.x) * a.z + n.x * a.x);
    open.horizon.blocked += is ? arc.opacity * openBetween(open, top, end) * gained : 0.0;
    // Without a gap, the horizon is exact where bins are not.
    bool stands = is && arc.opacity > 0.97 && bottom > open.horizon.angle - 0.02;
    open.horizon.square = stands ? high.y * abs(high.y) / dot(high, high) : open.horizon.square;
    open.horizon.angle = stands ? top : open.horizon.angle;
    ivec2 bins = ivec2(clamp(vec2(top, end) * open.perBin + float(seed >> 16 & 255u) * (1.0 / 256.0), 0.0, 32.0));
    open.covered |= is && !stands ? bitfieldInsert(0u, ~0u, bins.x, max(bins.y - bins.x, 0)) & someOf(arc.opacity, seed) : 0u;
}

// As raise(), through what things leave open.
void raiseBehind(inout Open open, vec2 point, vec2 slab, vec2 before, float connection, bool found, vec2 n, float unit) {
    float blocked = open.horizon.blocked, angle = open.horizon.angle;
    raise(open.horizon, point, slab, before, connection, found && raises(open.horizon, point), n, unit);
    open.horizon.blocked = blocked + (open.horizon.blocked - blocked) * openBetween(open, open.horizon.angle, angle);
}

#endif
