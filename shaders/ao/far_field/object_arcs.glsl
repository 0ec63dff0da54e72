// Occlusion of a segment by background and objects. The background, and objects without a gap to it, raise a horizon (estimator.glsl).
// Objects above a gap cover bins of the arc between zenith and tangent plane, of which there are 32; later occluders count by the open
// fraction of their arc. An object of opacity below 1 covers that fraction of its bins, always the same ones in a segment, because the next
// occluder is mostly the same object, and to avoid flicker.
#ifndef OBSCURA_FAR_FIELD_THINGS_MET_GLSL
#define OBSCURA_FAR_FIELD_THINGS_MET_GLSL
#include "ao/far_field/estimator.glsl"

struct Open {
    Horizon horizon;
    uint covered;
    uint pattern;       // selects the bins that evenBins() takes first
    float perBin;       // bins per radian from the zenith
};
Open openAt(float cosine, uint pattern) { return Open(horizonAt(cosine), 0u, pattern, 32.0 / arcCosine(cosine)); }

float freeBelow(uint covered, float place) {
    int i = int(place);
    return float(bitCount(~covered & (i > 31 ? ~0u : (1u << i) - 1u))) + fract(place) * float((~covered >> min(i, 31)) & 1u);
}
// Mask of `share` of all bins, in eighths, evenly spread; turn rotates it.
uint evenBins(float share, uint turn) {
    uint eighths = uint(share * 8.0 + 0.5), by = 1u + (turn & 7u);
    uint pattern = (((eighths < 4u ? 0x49110100u : 0x7f776d55u) >> (8u * (eighths & 3u))) & 255u) * 0x01010101u;
    return eighths > 7u ? ~0u : pattern << by | pattern >> (32u - by);
}

// Adds the arc from `point` down to the end of `line` or to the horizon, whichever is higher, as raise() does, weighted by its open
// fraction. An opaque object without a gap to the horizon raises the horizon, which is exact, instead of covering bins.
void addOccluder(inout Open open, vec2 point, vec2 line, bool object, float opacity, bool found, vec2 n, float unit) {
    point.x = max(point.x, 1e-9);
    vec2 low = point + line;
    low.x = max(low.x, 1e-9);
    float inverse2 = 1.0 / max(dot(line, line), 1e-30), area = max(line.x * point.y - line.y * point.x, 0.0);
    float angle = arcTangent(point.x, point.y), bottom = object ? arcTangent(low.x, low.y) : kPi, end = min(bottom, open.horizon.angle);
    float phi2 = arcTangent(area, dot(line, point)), phi1 = max(phi2 - (end - angle), 0.0), b = area * sqrt(inverse2);
    vec3 a = tableDifference(min(phi1, phi2), phi2, b / (b + unit));
    vec2 twice = vec2(2.0 * line.x * line.y, line.y * line.y - line.x * line.x) * inverse2;
    float gained = 0.5 * ((twice.x * n.y - twice.y * n.x) * a.y - (twice.y * n.y + twice.x * n.x) * a.z + n.x * a.x);
    vec2 place = clamp(vec2(angle, end) * open.perBin, 0.0, 32.0);
    float through = clamp((freeBelow(open.covered, place.y) - freeBelow(open.covered, place.x)) / max(place.y - place.x, 1e-3), 0.0, 1.0);
    found = found && end > angle;
    open.horizon.blocked += found ? opacity * through * gained : 0.0;
    bool raised = found && opacity > 0.97 && bottom > open.horizon.angle - 0.02;
    ivec2 bins = ivec2(place + 0.5);
    open.covered |= found && !raised ? bitfieldInsert(0u, ~0u, bins.x, max(bins.y - bins.x, 0)) & evenBins(opacity, open.pattern) : 0u;
    open.horizon.square = raised ? point.y * abs(point.y) / dot(point, point) : open.horizon.square;
    open.horizon.connected =
        found && !object ? min(open.horizon.connected + kConnectionRate * (open.horizon.angle - angle), 1.0) : open.horizon.connected;
    open.horizon.angle = raised ? angle : open.horizon.angle;
}

#endif
