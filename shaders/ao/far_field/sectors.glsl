// One segment of a sector: the near field, texel by texel, then intervals of growing length to the picture's edge. Include after declaring
// `table`, `depth`, `cells` and `directionsOf`, kAveraging and kThin.
#ifndef OBSCURA_FAR_FIELD_SECTORS_GLSL
#define OBSCURA_FAR_FIELD_SECTORS_GLSL
#include "ao/far_field/estimator.glsl"
#include "ao/far_field/grid.glsl"
#include "ao/far_field/receiver.glsl"
#include "ao/far_field/thin.glsl"

// From a sector's middle to its first segment, from segment to segment, half a segment: cosine and sine.
struct Turn {
    vec2 first, next, side;
    float slope;  // of a sector's sides, lines per pixel of distance
    float shift;  // of all lines by jitter, the same
};
// All of a pixel's segments turned by one random angle [Timonen 2013, sec. 11.1].
Turn jittered(Turn turn, View view, ivec2 texel, FarFieldConstants c) {
    vec2 by = jitterAt(view, texel, kPi / float(c.directions * c.segments), c.jitter);
    turn.first = mat2(turn.first, vec2(-turn.first.y, turn.first.x)) * by;
    turn.shift = by.y / by.x / c.lineStep;
    return turn;
}
Turn turnOf(FarFieldConstants c) {
    float sector = kPi / float(c.directions), segment = sector / float(c.segments), slope = tan(sector) / c.lineStep;
    return Turn(vec2(cos(segment - sector), sin(segment - sector)), vec2(cos(2.0 * segment), sin(2.0 * segment)), vec2(cos(segment), sin(segment)), slope, 0.0);
}

// Where a receiver stands in a direction's grid.
struct Place {
    Direction d;
    float along;  // pixels from the grid's first interval
    float line;   // lines from its first
    uint first;   // interval: at least B0 pixels away [alg. 2]
    Axis axis;
};
Place placeOf(Direction d, Receiver r, FarFieldConstants c) {
    vec2 at = r.pixel - 0.5 * r.size;
    float along = dot(at, d.along) + d.origin.x, line = (dot(at, vec2(-d.along.y, d.along.x)) + d.origin.y) / c.lineStep;
    return Place(d, along, line, uint(ceil(along / c.interval)) + 1u, axisOf(viewBlock, d.along));
}

// What a segment has met so far: a horizon, or bins where surfaces are thin.
struct Met {
    Horizon horizon;
    Bins bins;
};
// Whether a point that exists may block anything; add() it if so.
bool counts(Met met, vec2 point) { return kThin != 0u || raises(met.horizon, point); }
void add(inout Met met, Segment s, FarFieldConstants c, vec2 point, bool found, float share) {
    vec2 slab = slabAt(s, point);
    if (kThin != 0u) addSlab(met.bins, point, normalize(slab), c.thickness, found, s.n * share, c.unit);
    else raise(met.horizon, point, slab, found, s.n * share, c.connection, c.unit);
}
float blockedOf(Met met) { return kThin != 0u ? met.bins.sum : met.horizon.blocked; }

// (unit / depth, pixels along the direction from the grid's start) of interval j of level n between lines `from` and `to`.
vec2 cellAt(Place at, FarFieldConstants c, uint n, uint j, float middle, float from, float to) {
    if (kAveraging == kPyramid) {
        uint lines = at.d.lines >> n, row = levelBase(at.d, n, kPyramid) + j * lines;
        float line = clamp(0.5 * (from + to) / float(1u << n) - 0.5, 0.0, float(lines - 1u));
        uint l = min(uint(line), lines - 2u);
        vec2 point = mix(unpackHalf2x16(cells[row + l]), unpackHalf2x16(cells[row + l + 1u]), line - float(l));
        return vec2(point.x, point.y + middle);
    }
    uint intervals = at.d.intervals >> n, column = levelBase(at.d, n, kAveraging) + j;
    vec2 heights;
    if (kAveraging == kSingle) {
        uint a = (column + uint(clamp(0.5 * (from + to), 0.0, float(at.d.lines - 1u))) * intervals) * 2u;
        heights = uintBitsToFloat(uvec2(cells[a], cells[a + 1u]));
    } else {
        float last = float(at.d.lines - 1u);
        uint l0 = uint(clamp(floor(from), 0.0, last)), l1 = uint(clamp(max(floor(to), floor(from) + 1.0) - 1.0, 0.0, last));
        uint a = (column + l1 * intervals) * 3u, b = (column + (max(l0, 1u) - 1u) * intervals) * 3u;
        vec3 sum = uintBitsToFloat(uvec3(cells[a], cells[a + 1u], cells[a + 2u]));
        sum -= l0 > 0u ? uintBitsToFloat(uvec3(cells[b], cells[b + 1u], cells[b + 2u])) : vec3(0.0);
        heights = sum.z > 0.5 ? sum.xy / sum.z : vec2(kNothing);
    }
    vec2 point = pointOf(at.axis, c, heights, 0.0);
    return vec2(point.x, point.y + at.d.origin.x);
}

// A point of a segment, from the receiver, and whether it counts.
struct Found {
    vec2 point;
    bool is;
};

// Sample i of `taps` over the first `reach` pixels, denser near the receiver.
Found nearPoint(Met met, Segment s, Receiver r, FarFieldConstants c, uint i, float reach, float skyDepth) {
    float t = (float(i) + 0.6) / float(c.taps);
    t = max(reach * t * sqrt(t), 0.7);
    float z = imageLoad(depth, clamp(ivec2(r.pixel + t * s.along), ivec2(0), ivec2(r.size) - 1)).x;
    vec2 point = pointAt(s, z, t);
    return Found(point, t < s.exit && z < skyDepth && counts(met, point));
}

// Interval j or the longest that begins there, is aligned and not longer than its distance; j goes on behind it. `low` and `high`: the
// segment's sides, lines per pixel of distance.
Found farPoint(Met met, Segment s, Receiver r, Place at, FarFieldConstants c, inout uint j, float low, float high, float nothing) {
    float gap = float(j) - at.along / c.interval;  // in intervals
    uint n = min(min(uint(findLSB(j)), uint(floatBitsToInt(gap) >> 23) - 127u), c.levels - 1u);
    float width = c.interval * float(1u << n), middle = (float(j >> n) + 0.5) * width, away = middle - at.along;
    vec2 cell = kAveraging == kDirect ? vec2(c.unit / imageLoad(depth, clamp(ivec2(r.pixel + away * s.along), ivec2(0), ivec2(r.size) - 1)).x, middle)
                                      : cellAt(at, c, n, j >> n, middle, at.line + low * away, at.line + high * away);
    vec2 point = pointAt(s, c.unit / max(cell.x, 1e-9), cell.y - at.along);
    j += 1u << n;
    return Found(point, cell.x > nothing && (kAveraging != kDirect || away < s.exit) && counts(met, point));
}

// Obscurance of direction k, not yet over pi, and the sector's width around the zenith.
vec2 sectorOf(Receiver r, uint k, FarFieldConstants c, Turn turn, float skyDepth) {
    Place at = placeOf(directionsOf[k], r, c);
    vec2 sum = vec2(0.0), along = mat2(turn.first, vec2(-turn.first.y, turn.first.x)) * at.d.along;
    float low = turn.shift - turn.slope, step = 2.0 * turn.slope / float(c.segments), reach = float(at.first) * c.interval - at.along;
    float nothing = kAveraging == kDirect ? c.unit / skyDepth : 0.0;  // the sky's unit / depth
    for (uint segment = 0u; segment < c.segments; ++segment) {
        Segment s = segmentOf(r, along, 1.0 / dot(along, at.d.along), turn.side);
        Met met = Met(horizonAt(s.start), binsBelow(s.start));
        uint i = 0u, j = at.first, end = (c.parts & kFarPart) != 0u ? uint(clamp(ceil((at.along + s.exit) / c.interval), 0.0, float(at.d.intervals))) : 0u;
        float share = (c.parts & kNearPart) != 0u ? 1.0 : 0.0;  // of what the near field blocks; it raises the horizon in any case
        while (i < c.taps || j < end) {  // first to the next point that counts, then what it blocks: neighbouring pixels do either together
            Found found = Found(vec2(0.0), false);
            while (!found.is && i < c.taps) found = nearPoint(met, s, r, c, i++, reach, skyDepth);
            bool isFar = !found.is;
            while (!found.is && j < end) found = farPoint(met, s, r, at, c, j, low, low + step, nothing);
            add(met, s, c, found.point, found.is, isFar ? 1.0 : share);
        }
        sum += s.weight * vec2(blockedOf(met), 1.0);
        low += step;
        along = mat2(turn.next, vec2(-turn.next.y, turn.next.x)) * along;
    }
    return sum;
}

#endif
