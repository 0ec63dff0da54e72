// The screen reference: one invocation per receiver and sequence marches rays through every texel of the depth buffer that they cross. In:
// linear depth (guard band included), receivers, falloffs as tables. Out: sums of rho(first hit), layout [receiver][falloff][sequence].
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/view.h"
#include "truth/rays.h"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View view; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, std430) readonly buffer Receivers { MarchReceiver receivers[]; };
layout(set = 0, binding = 3, std430) readonly buffer Tables { float tables[]; };  // reaches first, then samples of each
layout(set = 0, binding = 4, std430) writeonly buffer Sums { float sums[]; };
layout(push_constant) uniform Constants { MarchConstants c; };

const uint kMaxFalloffs = 8u;

float rho(uint falloff, float d) {
    float reach = tables[falloff];
    if (d > reach) return 0.0;
    float x = d / reach * float(c.tableSize - 1u);
    uint i = min(uint(x), c.tableSize - 2u);
    uint at = c.falloffs + falloff * c.tableSize + i;
    return mix(tables[at], tables[at + 1u], x - float(i));
}

// Metres to the first point behind the depth buffer; negative if the ray escapes. Traverses the texels of the projected segment in order
// [Amanatides and Woo 1987]; s is the fraction of the segment.
float march(vec3 origin, vec3 direction) {
    bool perspective = view.orthographic < 0.5;
    float d0 = -origin.z, slope = -direction.z;
    float t1 = c.rayLength;
    if (slope < 0.0) t1 = min(t1, (d0 - c.near) / -slope);
    if (t1 <= 0.0) return -1.0;
    float d1 = d0 + slope * t1;
    float w0 = perspective ? d0 : 1.0, w1 = perspective ? d1 : 1.0;
    vec2 p0 = pixelOf(view, origin);
    vec2 segment = pixelOf(view, origin + direction * t1) - p0;

    ivec2 texel = ivec2(floor(p0));
    ivec2 forward = ivec2(segment.x < 0.0 ? -1 : 1, segment.y < 0.0 ? -1 : 1);
    vec2 delta = vec2(abs(segment.x) > 1e-9 ? 1.0 / abs(segment.x) : 1e30, abs(segment.y) > 1e-9 ? 1.0 / abs(segment.y) : 1e30);
    vec2 inside = p0 - vec2(texel);
    vec2 next = vec2(forward.x > 0 ? 1.0 - inside.x : inside.x, forward.y > 0 ? 1.0 - inside.y : inside.y) * delta;
    ivec2 size = ivec2(view.size);

    float enterT = 0.0, enterD = d0;
    vec2 before = vec2(0.0, -1.0);  // at the middle of the previous texel: t, metres behind the depth buffer
    bool first = true;
    while (all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, size))) {
        float s = min(min(next.x, next.y), 1.0);
        float leaveT = t1 * s * w0 / ((1.0 - s) * w1 + s * w0);
        float leaveD = d0 + slope * leaveT;
        float z = imageLoad(depth, texel).x;
        float front = z + c.tolerance * (perspective ? z : 1.0), back = front + c.thickness;
        vec2 here = vec2(enterT + leaveT, enterD + leaveD) * 0.5 - vec2(0.0, z);
        if (max(enterD, leaveD) > front && min(enterD, leaveD) < back && !isSky(view, z)) {
            if (enterD >= back) return (back - d0) / slope;              // from behind
            if (enterD > front + 2.0 * (front - z)) return enterT;       // past a silhouette
            // The ray crosses the surface between the centres of two texels, or was within the tolerance for a texel or two: the crossing
            // is extrapolated linearly from both.
            float crossing = first || here.y <= before.y ? enterT : mix(before.x, here.x, before.y / (before.y - here.y));
            return clamp(crossing, max(before.x - 2.0 * (here.x - before.x), 0.0), leaveT);
        }
        if (s >= 1.0) break;
        first = false;
        before = here;
        enterT = leaveT;
        enterD = leaveD;
        if (next.x < next.y) {
            texel.x += forward.x;
            next.x += delta.x;
        } else {
            texel.y += forward.y;
            next.y += delta.y;
        }
    }
    return -1.0;
}

void main() {
    uint index = gl_GlobalInvocationID.x / kSequences, sequence = gl_GlobalInvocationID.x % kSequences;
    if (index >= c.receivers) return;
    MarchReceiver receiver = receivers[index];
    uint seed = floatBitsToUint(receiver.normal.w);
    float sum[kMaxFalloffs];
    for (uint f = 0u; f < kMaxFalloffs; ++f) sum[f] = 0.0;
    for (uint i = 0u; i < c.points; ++i) {
        uint point = c.firstPoint + i;
        float hit =
            march(receiver.position.xyz, rayDirection(receiver.normal.xyz, rayU(point, sequence, seed), rayV(point, sequence, seed)));
        if (hit >= 0.0)
            for (uint f = 0u; f < c.falloffs; ++f) sum[f] += rho(f, hit);
    }
    for (uint f = 0u; f < c.falloffs; ++f) sums[(index * c.falloffs + f) * kSequences + sequence] = sum[f];
}
