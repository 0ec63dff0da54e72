// Obscurance from a depth pyramid: samples at distances that grow by a factor, from the level whose texels are as wide as the sector
// there, and one at the picture's edge [Timonen 2013, sec. 5]. The estimator is far_field's, with slabs.
// In: packed normals, depth pyramid, the falloff's table. Out: visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 2) uniform sampler2D pyramid;
layout(set = 0, binding = 3, rgba32ui) uniform readonly uimage2D table;
layout(set = 0, binding = 4, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Constants {
    uint directions;  // K
    float factor;     // from step to step
    float unit;       // metres: the falloff's length
};
#include "ao/far_field/estimator.glsl"
#include "ao/far_field/receiver.glsl"

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 texel = p + ivec2(view.guard);
    float z = texelFetch(pyramid, texel, 0).x;
    if (isSky(view, z)) {
        imageStore(visibility, p, vec4(1.0));
        return;
    }
    Receiver r = receiverAt(view, texel, z, unpackNormal(imageLoad(normals, texel).x));
    float growth = factor, metres = unit, half_ = kPi / float(directions), width = 2.0 * tan(half_);
    vec2 texelSize = 1.0 / r.size, sum = vec2(0.0), side = vec2(cos(half_), sin(half_)), along = vec2(1.0, 0.0);
    mat2 next = mat2(cos(2.0 * half_), sin(2.0 * half_), -sin(2.0 * half_), cos(2.0 * half_));
    for (uint k = 0u; k < directions; ++k) {
        Segment s = segmentOf(r, along, 1.0, side);
        Horizon h = horizonAt(s.start);
        float edge = s.exit - 0.5, t = 1.0, step = 1.0;
        bool more = true;
        while (more) {
            more = t < edge;
            float at = min(t, edge);
            float sampled = textureLod(pyramid, (r.pixel + at * s.along) * texelSize, log2(max(width * at, 1.0))).x;
            vec2 point = pointAt(s, sampled, at);
            addPoint(h, point - vec2(0.0, s.origin), vec2(point.x * s.scale.x, point.y), sampled < view.skyDepth, s.n, 0.0, metres);
            step *= growth;
            t += step;
        }
        sum += s.weight * vec2(h.blocked, 1.0);
        along = next * along;
    }
    imageStore(visibility, p, vec4(clamp(1.0 - 2.0 * sum.x / sum.y, 0.0, 1.0)));
}
