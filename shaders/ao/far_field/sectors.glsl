// Evaluation of a sector, segment by segment: near-field texels, then intervals of growing length to the edge of the image. Also the
// bindings of its passes, except for receivers (2) and results (6). Include after declaring kThin.
#ifndef OBSCURA_FAR_FIELD_SECTORS_GLSL
#define OBSCURA_FAR_FIELD_SECTORS_GLSL
#include "ao/far_field/constants.h"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 3, std430) readonly buffer Directions { Direction directionsOf[]; };
#define CELLS_BINDING 4
#define CELLS_ACCESS readonly
#include "ao/far_field/cells.glsl"
layout(set = 0, binding = 5, rgba32ui) uniform readonly uimage2D table;
layout(push_constant) uniform Block { FarFieldConstants constants; };
#include "ao/far_field/estimator.glsl"
#include "ao/far_field/grid.glsl"
#include "ao/far_field/receiver.glsl"
#include "ao/far_field/thin.glsl"

// Rotations (cosine and sine) from a sector's middle to its first segment, from segment to segment, and by half a segment.
struct Turn {
    vec2 first, next, side;
    float slope;  // of a sector's sides, lines per pixel of distance
    float shift;  // of all segments by jitter, lines per pixel of distance
};
float halfWidthOf(FarFieldConstants c) { return kPi * float(c.stride) / float(c.directions * c.segments); }  // of a segment
Turn turnedBy(Turn turn, FarFieldConstants c, vec2 by) {
    turn.first = mat2(turn.first, vec2(-turn.first.y, turn.first.x)) * by;
    turn.shift = by.y / by.x / c.lineStep;
    return turn;
}
// Turns all segments of a pixel by one random angle [Timonen 2013, sec. 11.1], or by a quarter segment with alternating sign on a
// checkerboard: the bands of a finite number of directions then alternate from pixel to pixel and are visible only beside tall objects.
Turn jittered(Turn turn, View view, ivec2 texel, FarFieldConstants c) {
    float halfWidth = halfWidthOf(c), quarter = ((texel.x + texel.y) & 1) == 0 ? 0.5 * halfWidth : -0.5 * halfWidth;
    return turnedBy(turn, c, c.alternate != 0u ? vec2(cos(quarter), sin(quarter)) : jitterAt(view, texel, halfWidth, c.jitter));
}
Turn turnOf(FarFieldConstants c) {
    float sector = kPi / float(c.directions), segment = sector / float(c.segments), slope = tan(sector) / c.lineStep;
    return Turn(vec2(cos(segment - sector), sin(segment - sector)), vec2(cos(2.0 * segment), sin(2.0 * segment)),
        vec2(cos(segment), sin(segment)), slope, 0.0);
}

// Position of a receiver in a direction's grid.
struct Place {
    Direction d;
    float along;  // pixels from the grid's first interval
    float line;   // lines from its first
    uint first;   // first interval, at least B0 pixels away [alg. 2]
    float perUnit;            // 1 / c.unit
    float perHeight, offset;  // of heights: pixels at depth 1 per metre of m0 - m1; pixels from the receiver to the image centre
};
Place placeOf(Direction d, Receiver r, FarFieldConstants c) {
    vec2 at = r.pixel - 0.5 * r.size;
    float along = dot(at, d.along) + d.origin.x, line = (dot(at, vec2(-d.along.y, d.along.x)) + d.origin.y) / c.lineStep;
    return Place(d, along, line, uint(ceil(along / c.interval)) + 1u, 1.0 / c.unit, d.perRise, d.origin.x - along - d.from / d.step);
}

// Occlusion of a segment so far: a horizon or, with kThin, bins.
struct Occlusion {
    Horizon horizon;
    Bins bins;
};
// Whether a point may block anything, and add() is needed.
bool counts(Occlusion occlusion, vec2 to) { return kThin != 0u || raises(occlusion.horizon, to); }
float blockedOf(Occlusion occlusion) { return kThin != 0u ? occlusion.bins.sum : occlusion.horizon.blocked; }

// What cellAt() returns: the arguments of seenAt(), over below kLeastOver if there is no point; and how many lines have one and, in the
// upper 16 bits, are in the image.
struct Cell {
    float across, depth, over;
    uint lines;
};
const uint kAllLines = 0x10001u;
// Interval j of level n, its middle `away` pixels from the receiver, between lines `from` and `to`.
Cell cellAt(Place at, Segment s, FarFieldConstants c, uint n, uint j, float away, float from, float to) {
    uint lines = kAveraging == kPyramid ? at.d.lines >> n : at.d.lines, row = levelBase(at.d, n, kAveraging) + j * lines;
    float last = float(lines - 1u);
#ifdef SUMS
    float count = max(floor(to - from + 0.5), 1.0), first = floor(0.5 * (from + to - count) + 0.5);
    uint l0 = uint(clamp(first, 0.0, last)), l1 = uint(clamp(first + count - 1.0, 0.0, last));
    uvec4 end = imageLoad(cells, texelOf(row + l1)), before = imageLoad(cells, texelOf(row + max(l0, 1u) - 1u));
    before = l0 > 0u ? before : uvec4(0u);
    vec2 sum = (uintBitsToFloat(end.xy) - uintBitsToFloat(before.xy)) + (unpackHalf2x16(end.w) - unpackHalf2x16(before.w));
    uint counts = end.z - before.z;
    float points = float(counts & 0xffffu);
    return Cell((sum.x - sum.y) * at.perHeight + (points * s.scale.y - sum.x * s.scale.x) * at.offset, -sum.x, points, counts);
#else
    vec2 point;
    if (kAveraging == kPyramid) {
        float line = clamp(0.5 * (from + to) * uintBitsToFloat((127u - n) << 23u) - 0.5, 0.0, last);  // over 2^n
        uint l = min(uint(line), lines - 2u);
        uint one = imageLoad(cells, texelOf(row + l)).x, two = imageLoad(cells, texelOf(row + l + 1u)).x;
        point = mix(vec2(uintBitsToFloat(one), placeIn(one)), vec2(uintBitsToFloat(two), placeIn(two)), line - float(l));
    } else {
        uint one = imageLoad(cells, texelOf(row + uint(clamp(0.5 * (from + to), 0.0, last)))).x;
        point = vec2(uintBitsToFloat(one), placeIn(one));
    }
    float width = c.interval * float(1u << n), inverse = point.x * at.perUnit;
    return Cell((s.scale.x + s.scale.y * inverse) * (point.y * (width / 256.0) + (away - width * (127.5 / 256.0))), 1.0,
        inverse, kAllLines);
#endif
}

// A point of a segment: vector from the receiver in metres = to / over; lines: as Cell's; valid: it may block.
struct Found {
    vec2 to;
    float over;
    uint lines;
    bool valid;
};
const float kLeastOver = 1.0e-20;  // less is no point
const Found kNone = Found(vec2(0.0), 0.0, kAllLines, false);
// The connection is to the previous point, visible or not, because surfaces between two visible points are lower than the line between
// them. If that is missing or sky (over 0), the slab alone is used.
void add(inout Occlusion occlusion, Segment s, FarFieldConstants c, Found found, Found before, float share) {
    vec2 point = found.to / max(found.over, 1e-12), slab = slabAt(s, point);
    if (kThin != 0u) addSlab(occlusion.bins, point, normalize(slab), c.thickness, found.valid, s.n * share, c.unit);
    else
        raise(occlusion.horizon, point, slab, before.to / max(before.over, 1e-12), before.over > kLeastOver ? c.connection : 0.0,
            kAveraging == kPrefix ? float(found.lines & 0xffffu) / float(found.lines >> 16u) : 1.0, found.valid, s.n * share, c.unit);
}

// Sample i of the near field, at (i + 0.6)^1.5 times `first` pixels: denser near the receiver.
Found nearPoint(Occlusion occlusion, Segment s, Receiver r, uint i, float first, float skyDepth) {
    float t = float(i) + 0.6;
    t = max(first * t * sqrt(t), 0.7);
    float z = imageLoad(depth, clamp(ivec2(r.pixel + t * s.along), ivec2(0), ivec2(r.size) - 1)).x;
    vec2 point = pointAt(s, z, t);
    return Found(point, 1.0, kAllLines, t < s.exit && z < skyDepth && counts(occlusion, point));
}

// The longest aligned interval that starts at j and is at most `longest` times its distance; j advances past it. low, high: the segment's
// sides, lines per pixel of distance.
Found farPoint(
    Occlusion occlusion, Segment s, Receiver r, Place at, FarFieldConstants c, inout uint j, float low, float high, float skyDepth) {
    float gap = max(c.longest * (float(j) - at.along / c.interval), 1.0);  // in intervals
    uint n = min(min(uint(findLSB(j)), uint(floatBitsToInt(gap) >> 23) - 127u), c.levels - 1u);
    float width = c.interval * float(1u << n), middle = (float(j >> n) + 0.5) * width, away = middle - at.along;
    Cell cell;
    if (kAveraging == kDirect) {
        float z = imageLoad(depth, clamp(ivec2(r.pixel + away * s.along), ivec2(0), ivec2(r.size) - 1)).x;
        cell = Cell((z * s.scale.x + s.scale.y) * away, z, z < skyDepth && away < s.exit ? 1.0 : 0.0, kAllLines);
    } else {
        cell = cellAt(at, s, c, n, j >> n, away, at.line + low * away, at.line + high * away);
    }
    vec2 to = seenAt(s, cell.across, cell.depth, cell.over);
    j += 1u << n;
    return Found(to, cell.over, cell.lines, cell.over > kLeastOver && counts(occlusion, to));
}

// Obscurance of direction k, not yet over pi, and the sector's width around the zenith.
vec2 sectorOf(Receiver r, uint k, FarFieldConstants c, Turn turn, float skyDepth) {
    Place at = placeOf(directionsOf[k], r, c);
    vec2 sum = vec2(0.0), along = mat2(turn.first, vec2(-turn.first.y, turn.first.x)) * at.d.along;
    float low = turn.shift - turn.slope, step = 2.0 * turn.slope / float(c.segments), taps = float(c.taps);
    float nearest = (float(at.first) * c.interval - at.along) / max(taps * sqrt(taps), 1.0);
    for (uint segment = 0u;;) {
        Segment s = segmentOf(r, along, 1.0 / dot(along, at.d.along), turn.side);
        Occlusion occlusion = Occlusion(horizonAt(s.start), binsBelow(s.start));
        uint i = 0u, j = at.first,
             end = (c.parts & kFarPart) != 0u ? uint(clamp(ceil((at.along + s.exit) / c.interval), 0.0, float(at.d.intervals))) : 0u;
        float share = (c.parts & kNearPart) != 0u ? 1.0 : 0.0;  // of near-field occlusion; its horizon rises anyway
        // Search for the next point that counts, then add it, so that neighbouring pixels diverge less. Neither search is inside a branch:
        // SwiftShader loses lanes of a loop in a branch that only some lanes take.
        Found found = kNone, before = found;
        do {
            bool hit = false;
            while (!hit && i < c.taps) {
                before = found;
                found = nearPoint(occlusion, s, r, i++, nearest, skyDepth);
                hit = found.valid;
            }
            bool isFar = !hit;
            while (!hit && j < end) {
                before = found;
                found = farPoint(occlusion, s, r, at, c, j, low, low + step, skyDepth);
                hit = found.valid;
            }
            add(occlusion, s, c, found, before, isFar ? 1.0 : share);
        } while (i < c.taps || j < end);
        sum += s.weight * vec2(blockedOf(occlusion), 1.0);
        low += step;
        along = mat2(turn.next, vec2(-turn.next.y, turn.next.x)) * along;
        if (++segment >= c.segments) break;
    }
    return sum;
}

#endif
