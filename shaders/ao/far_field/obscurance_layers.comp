// Obscurance from a background and objects in front of it: every sector of a pixel, near and far field [Timonen 2013, alg. 2].
// In: linear depth of the background, packed normals, directions, cells, the falloff's table, objects and their cells, linear depth.
// Out: visibility. BATCH as in obscurance.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant BATCH
const uint kThin = 0u;
#include "ao/far_field/sectors.glsl"
#include "ao/far_field/objects.glsl"
#include "ao/far_field/object_arcs.glsl"
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 6, r16f) uniform writeonly image2D visibility;
layout(set = 0, binding = 7, rg32ui) uniform readonly uimage2D objects;
layout(set = 0, binding = 8, rg32ui) uniform readonly uimage2D objectCells;
layout(set = 0, binding = 9, r32f) uniform readonly image2D surfaces;
#ifdef BATCH
layout(set = 0, binding = 10, rg32f) uniform image2D sums;
#endif

// An object over an interval along a segment: the highest corner of its front (high / over, metres) and the data for the lowest corner of
// its back.
struct Arc {
    vec2 high;
    float over;
    vec2 ends, fronts;  // of the interval: pixels from the receiver, 1 / depth of the front
    float ratio;        // depth of the front / depth of the back
    float opacity;
    bool valid;
};
vec2 cornerAt(Segment s, float away, float inverse) { return seenAt(s, (s.scale.x + s.scale.y * inverse) * away, 1.0, inverse); }
// object: as unpackObject() returns it, its gain that over the whole interval, in proportion to coverage.
Arc arcOf(Segment s, Horizon h, vec4 object, float perUnit, vec2 ends) {
    float front = object.x / max(object.z, 1e-6) * perUnit, bend = clamp(0.5 * object.w * perUnit, -0.8 * front, 0.8 * front);
    vec2 fronts = vec2(front - bend, front + bend), first = cornerAt(s, ends.x, fronts.x), last = cornerAt(s, ends.y, fronts.y);
    bool atEnd = first.x * last.y > first.y * last.x;
    vec2 high = atEnd ? last : first;
    return Arc(high, atEnd ? fronts.y : fronts.x, ends, fronts, object.y / max(object.x, 1e-12), min(object.z, 1.0),
        object.z > 0.004 && raises(h, high));
}
vec2 lowestOf(Segment s, Arc arc) {  // metres
    vec2 backs = arc.fronts * arc.ratio, first = cornerAt(s, arc.ends.x, backs.x), last = cornerAt(s, arc.ends.y, backs.y);
    bool atEnd = last.x * first.y > last.y * first.x;
    return (atEnd ? last : first) / max(atEnd ? backs.y : backs.x, 1e-12);
}

// The line below a background point, see raise().
vec2 lineBelow(vec2 slab, vec2 before, float connection) {
    float longer = sqrt(max(dot(slab, slab), 1e-30) / max(dot(before, before), 1e-30));
    return slab * (1.0 - connection) + before * (connection * longer);
}

// Sample i of the near field, at (i + 0.6)^1.5 times `first` pixels; its object stands for the interval around it.
void nearest(Segment s, Receiver r, Place at, Horizon h, uint i, float first, float skyDepth, out Found found, out Arc arc) {
    vec3 t = float(i) + vec3(0.0, 0.6, 1.0);
    t = max(first * t * sqrt(t), vec3(0.5, 0.7, 1.0));
    ivec2 texel = clamp(ivec2(r.pixel + t.y * s.along), ivec2(0), ivec2(r.size) - 1);
    float z = imageLoad(depth, texel).x;
    uvec2 object = imageLoad(objects, texel).xy;
    vec2 point = pointAt(s, z, t.y), layer = unpackSurface(object.x), growth = unpackHalf2x16(object.y);
    bool inside = t.y < s.exit;
    found = Found(point, 1.0, kAllLines, inside && z < skyDepth && raises(h, point));
    // From the middle of the texel to that of the interval.
    layer *= 1.0 + clamp(dot(growth, r.pixel + 0.5 * (t.x + t.z) * s.along - (vec2(texel) + 0.5)) / max(layer.x, 1e-6), -0.8, 0.8);
    arc = arcOf(s, h, vec4(layer, inside && object.x != 0u ? 1.0 : 0.0, dot(growth, s.along) * (t.z - t.x)), at.perUnit, t.xz);
}

// As farPoint(), and the objects of the interval. kept: the direction whose object cells are stored: this one, or its opposite.
void next(Segment s, Place at, FarFieldConstants c, Horizon h, Direction kept, bool opposite, float low, float high, inout uint j,
    out Found found, out Arc arc) {
    float gap = max(c.longest * (float(j) - at.along / c.interval), 1.0);  // in intervals
    uint n = min(min(uint(findLSB(j)), uint(floatBitsToInt(gap) >> 23) - 127u), c.levels - 1u), jn = j >> n;
    float width = c.interval * float(1u << n), middle = (float(jn) + 0.5) * width, away = middle - at.along;
    Cell cell = cellAt(at, s, c, n, jn, away, at.line + low * away, at.line + high * away);
    vec2 to = seenAt(s, cell.across, cell.depth, cell.over);
    found = Found(to, cell.over, kAllLines, cell.over > kLeastOver && raises(h, to));
    uint lines = at.d.lines >> n;
    float line = clamp((at.line + 0.5 * (low + high) * away) * uintBitsToFloat((127u - n) << 23u) - 0.5, 0.0, float(lines - 1u));
    line = opposite ? float(lines - 1u) - line : line;
    uint l = min(uint(line), lines - 2u), row = levelBase(kept, n, kPyramid) + (opposite ? (at.d.intervals >> n) - 1u - jn : jn) * lines;
    vec4 object = mix(unpackObject(imageLoad(objectCells, texelOf(row + l)).xy),
        unpackObject(imageLoad(objectCells, texelOf(row + l + 1u)).xy), line - float(l));
    object.w *= opposite ? -float(1u << n) : float(1u << n);
    arc = arcOf(s, h, object, at.perUnit, away + vec2(-0.5, 0.5) * width);
    j += 1u << n;
}

// Obscurance of direction k, not yet over pi, and the sector's width around the zenith.
vec2 layeredSectorOf(Receiver r, uint k, FarFieldConstants c, Turn turn, float skyDepth) {
    Place at = placeOf(directionsOf[k], r, c);
    bool opposite = c.paired != 0u && k >= c.directions / 2u;
    Direction kept = directionsOf[opposite ? k - c.directions / 2u : k];
    vec2 sum = vec2(0.0), along = mat2(turn.first, vec2(-turn.first.y, turn.first.x)) * at.d.along;
    float low = turn.shift - turn.slope, step = 2.0 * turn.slope / float(c.segments), taps = float(c.taps);
    float first = (float(at.first) * c.interval - at.along) / max(taps * sqrt(taps), 1.0);
    for (uint segment = 0u;;) {
        Segment s = segmentOf(r, along, 1.0 / dot(along, at.d.along), turn.side);
        Open open = openAt(s.start, k * c.segments + segment);
        uint i = 0u, j = at.first,
             end = (c.parts & kFarPart) != 0u ? uint(clamp(ceil((at.along + s.exit) / c.interval), 0.0, float(at.d.intervals))) : 0u;
        float share = (c.parts & kNearPart) != 0u ? 1.0 : 0.0;
        Found found = kNone, before = found;
        Arc arc = Arc(vec2(0.0), 1.0, vec2(0.0), vec2(1.0), 1.0, 0.0, false);
        bool isFar = false;
        do {  // as sectorOf(): search for the next point or object that counts, then add it, objects first
            bool isLeft = found.valid, hit = isLeft;  // the point whose object was added before it
            while (!hit && i < c.taps) {
                before = found;
                nearest(s, r, at, open.horizon, i++, first, skyDepth, found, arc);
                hit = found.valid || arc.valid;
            }
            isFar = isLeft ? isFar : !hit;
            while (!hit && j < end) {
                before = found;
                next(s, at, c, open.horizon, kept, opposite, low, low + step, j, found, arc);
                hit = found.valid || arc.valid;
            }
            bool object = arc.valid;
            vec2 point = object ? arc.high / arc.over : found.to / max(found.over, 1e-12), n = s.n * (isFar ? 1.0 : share);
            vec2 line = object ? lowestOf(s, arc) - point
                               : lineBelow(slabAt(s, point), before.to / max(before.over, 1e-12) - point,
                                     before.over > kLeastOver ? c.connection * open.horizon.connected : 0.0);
            addOccluder(open, point, line, object, object ? arc.opacity : 1.0, object || (found.valid && raises(open.horizon, found.to)), n,
                c.unit);
            found.valid = found.valid && object;
            arc.valid = false;
        } while (found.valid || i < c.taps || j < end);
        sum += s.weight * vec2(open.horizon.blocked, 1.0);
        low += step;
        along = mat2(turn.next, vec2(-turn.next.y, turn.next.x)) * along;
        if (++segment >= c.segments) break;
    }
    return sum;
}

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    FarFieldConstants c = constants;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 texel = p + ivec2(view.guard);
    float z = imageLoad(surfaces, texel).x;
    if (isSky(view, z)) {
        imageStore(visibility, p, vec4(1.0));
        return;
    }
    Receiver r = receiverAt(view, texel, z, unpackNormal(imageLoad(normals, texel).x));
    Turn turn = jittered(turnOf(c), view, texel, c);
    vec2 sum = vec2(0.0);
    for (uint i = 0u;;) {  // post-tested, see sectors.glsl
        sum += layeredSectorOf(r, directionOf(c, i), c, turn, view.skyDepth);
        if ((i += c.stride) >= batchOf(c)) break;
    }
#ifdef BATCH
    if (c.first > 0u) sum += imageLoad(sums, p).xy;
    imageStore(sums, p, vec4(sum, 0.0, 0.0));
#endif
    imageStore(visibility, p, vec4(clamp(1.0 - 2.0 * sum.x / sum.y, 0.0, 1.0)));
}
