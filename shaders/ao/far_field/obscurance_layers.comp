// Obscurance of a background and of things before it: every sector of a pixel, near and far [Timonen 2013, alg. 2].
// In: the background's linear depth, packed normals, directions, cells, the falloff's table, things and their cells, linear depth. Out: visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
const uint kThin = 0u;
#include "ao/far_field/sectors.glsl"
#include "ao/far_field/things.glsl"
#include "ao/far_field/things_met.glsl"
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 6, r16f) uniform writeonly image2D visibility;
layout(set = 0, binding = 7, rg32ui) uniform readonly uimage2D things;
layout(set = 0, binding = 8, rg32ui) uniform readonly uimage2D thingCells;
layout(set = 0, binding = 9, r32f) uniform readonly image2D surfaces;

// What a thing (front, back: unit / depth; covered; gain of the front's over the stretch) fills between `from` and `to` pixels along a segment.
Arc arcOf(Segment s, Horizon h, vec4 thing, float perUnit, float from, float to) {
    float share = 1.0 / max(thing.z, 1e-6), front = thing.x * share * perUnit, ratio = thing.y / max(thing.x, 1e-12);
    float bend = clamp(0.5 * thing.w * perUnit, -0.8 * front, 0.8 * front);
    vec2 fronts = vec2(front - bend, front + bend), backs = fronts * ratio;
    vec2 f0 = seenAt(s, (s.scale.x + s.scale.y * fronts.x) * from, 1.0, fronts.x), f1 = seenAt(s, (s.scale.x + s.scale.y * fronts.y) * to, 1.0, fronts.y);
    vec2 b0 = seenAt(s, (s.scale.x + s.scale.y * backs.x) * from, 1.0, backs.x), b1 = seenAt(s, (s.scale.x + s.scale.y * backs.y) * to, 1.0, backs.y);
    bool highAtEnd = f0.x * f1.y > f0.y * f1.x, lowAtEnd = b0.x * b1.y < b0.y * b1.x;
    Arc arc;
    arc.high = highAtEnd ? f1 : f0;
    arc.low = lowAtEnd ? b1 : b0;
    arc.over = vec2(highAtEnd ? fronts.y : fronts.x, lowAtEnd ? backs.y : backs.x);
    arc.opacity = min(thing.z, 1.0);
    arc.is = thing.z > 0.004 && raises(h, arc.high);
    return arc;
}

// Obscurance of direction k, not yet over pi, and the sector's width around the zenith.
vec2 layeredSectorOf(Receiver r, uint k, FarFieldConstants c, Turn turn, float skyDepth) {
    Place at = placeOf(directionsOf[k], r, c);
    bool opposite = c.paired != 0u && k >= c.directions / 2u;
    Direction kept = directionsOf[opposite ? k - c.directions / 2u : k];
    vec2 sum = vec2(0.0), along = mat2(turn.first, vec2(-turn.first.y, turn.first.x)) * at.d.along;
    float low = turn.shift - turn.slope, step = 2.0 * turn.slope / float(c.segments), taps = float(c.taps);
    float nearest = (float(at.first) * c.interval - at.along) / max(taps * sqrt(taps), 1.0);
    ivec2 last = ivec2(r.size) - 1;
    for (uint segment = 0u;;) {
        Segment s = segmentOf(r, along, 1.0 / dot(along, at.d.along), turn.side);
        Open open = openAt(s.start);
        uint i = 0u, j = at.first, end = (c.parts & kFarPart) != 0u ? uint(clamp(ceil((at.along + s.exit) / c.interval), 0.0, float(at.d.intervals))) : 0u;
        float share = (c.parts & kNearPart) != 0u ? 1.0 : 0.0;
        Found found = Found(vec2(0.0), 0.0, false), before = found;
        Arc arc = Arc(vec2(0.0), vec2(0.0), vec2(1.0), 0.0, false);
        while (true) {
            bool isFar = true;
            uint seed = 0u;
            if (i < c.taps) {
                while (true) {
                    before = found;
                    float t = float(i) + 0.6, t0 = float(i), t1 = t0 + 1.0;
                    t = max(nearest * t * sqrt(t), 0.7);
                    t0 = max(nearest * t0 * sqrt(t0), 0.5);
                    t1 = max(nearest * t1 * sqrt(t1), t0 + 0.5);
                    ivec2 texel = clamp(ivec2(r.pixel + t * s.along), ivec2(0), last);
                    float z = imageLoad(depth, texel).x;
                    uvec2 thing = imageLoad(things, texel).xy;
                    vec2 point = pointAt(s, z, t), growth = unpackHalf2x16(thing.y);
                    found = Found(point, 1.0, t < s.exit && z < skyDepth && raises(open.horizon, point));
                    // The texel's plane goes on to the middle of the stretch.
                    vec2 front = unpackHalf2x16(thing.x);
                    front *= 1.0 + clamp(dot(growth, r.pixel + 0.5 * (t0 + t1) * s.along - (vec2(texel) + 0.5)) / max(front.x, 1e-6), -0.8, 0.8);
                    arc = arcOf(s, open.horizon, vec4(front, thing.x != 0u && t < s.exit ? 1.0 : 0.0, dot(growth, s.along) * (t1 - t0)), at.perUnit, t0, t1);
                    ++i;
                    if (found.is || arc.is || i >= c.taps) break;
                }
                seed = i * 0x9e3779b9u;
                isFar = !found.is && !arc.is;
            }
            if (isFar && j < end) {
                while (true) {
                    before = found;
                    float gap = max(c.longest * (float(j) - at.along / c.interval), 1.0);  // in intervals
                    uint n = min(min(uint(findLSB(j)), uint(floatBitsToInt(gap) >> 23) - 127u), c.levels - 1u);
                    float width = c.interval * float(1u << n), middle = (float(j >> n) + 0.5) * width, away = middle - at.along;
                    vec3 cell = cellAt(at, s, c, n, j >> n, middle, at.line + low * away, at.line + (low + step) * away);
                    vec2 to = seenAt(s, cell.x, cell.y, cell.z);
                    found = Found(to, cell.z, cell.z > 0.0 && raises(open.horizon, to));
                    uint lines = at.d.lines >> n, jn = j >> n;
                    float line = clamp((at.line + (low + 0.5 * step) * away) * uintBitsToFloat((127u - n) << 23u) - 0.5, 0.0, float(lines - 1u));
                    line = opposite ? float(lines - 1u) - line : line;
                    uint l = min(uint(line), lines - 2u), row = levelBase(kept, n, kPyramid) + (opposite ? (at.d.intervals >> n) - 1u - jn : jn) * lines;
                    vec4 thing = mix(unpackThing(imageLoad(thingCells, texelOf(row + l)).xy), unpackThing(imageLoad(thingCells, texelOf(row + l + 1u)).xy), line - float(l));
                    thing.w *= (opposite ? -1.0 : 1.0) * float(1u << n);
                    arc = arcOf(s, open.horizon, thing, at.perUnit, away - 0.5 * width, away + 0.5 * width);
                    j += 1u << n;
                    if (found.is || arc.is || j >= end) break;
                }
                seed = (j * 8u + segment) * 0x9e3779b9u;
            }
            vec2 n = s.n * (isFar ? 1.0 : share);
            seed = (k * 8u + segment) * 0x85ebca6bu;
            cover(open, arc, n, c.unit, seed * 0xc2b2ae35u);
            vec2 point = found.to / max(found.over, 1e-12);
            raiseBehind(open, point, slabAt(s, point), before.to / max(before.over, 1e-12), before.over > 0.0 ? c.connection : 0.0, found.is, n, c.unit);
            if (i >= c.taps && j >= end) break;
        }
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
    for (uint k = 0u;;) {  // ends with its test, see sectors.glsl
        sum += layeredSectorOf(r, k, c, turn, view.skyDepth);
        if ((k += c.stride) >= c.directions) break;
    }
    imageStore(visibility, p, vec4(clamp(1.0 - 2.0 * sum.x / sum.y, 0.0, 1.0)));
}
