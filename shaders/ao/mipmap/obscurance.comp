// Obscurance from a depth pyramid: samples at distances that grow by a factor, from the level whose texels are as wide as the sector there,
// and one at the edge of the image [Timonen 2013, sec. 5]. The estimator is far_field's, with slabs. With kThin depths are not averaged:
// texels hold the nearest depth and one level is read [sec. 11].
// In: packed normals, depth pyramid, the falloff's table. Out: visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/mipmap/constants.h"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kThin = 0;
layout(constant_id = 1) const bool kLarger = false;  // the pyramid's image is larger than view.size (dynamic resolution)
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 2) uniform sampler2D pyramid;
layout(set = 0, binding = 3, rgba32ui) uniform readonly uimage2D table;
layout(set = 0, binding = 4, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Block { MipmapObscurance constants; };
#include "ao/far_field/estimator.glsl"
#include "ao/far_field/receiver.glsl"
#include "ao/far_field/thin.glsl"

// Bilinear sample of a level at a place in [0,1)^2 of the view: as the sampler's, where the image has texels beyond the view.
vec2 sampleOf(View view, vec2 place, int level) {
    vec2 size = vec2(max(view.size >> level, 1u)), texel = clamp(place * size, vec2(0.5), size - 0.5);
    return textureLod(pyramid, texel / vec2(max(textureSize(pyramid, 0) >> level, 1)), float(level)).xy;  // lavapipe: sizes of one level
}

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 texel = p + ivec2(view.guard);
    float z = texelFetch(pyramid, texel, 0).x;
    if (z == 0.0) {  // sky
        imageStore(visibility, p, vec4(1.0));
        return;
    }
    Receiver r = receiverAt(view, texel, z, unpackNormal(imageLoad(normals, texel).x));
    float growth = constants.factor, metres = constants.unit, thick = constants.thickness,
          half_ = kPi / float(constants.directions), width = 2.0 * tan(half_);
    vec2 texelSize = 1.0 / r.size, sum = vec2(0.0), side = vec2(cos(half_), sin(half_)),
         along = jitterAt(view, texel, half_, constants.jitter);
    mat2 next = mat2(cos(2.0 * half_), sin(2.0 * half_), -sin(2.0 * half_), cos(2.0 * half_));
    for (uint k = 0u;;) {  // post-tested, see far_field/sectors.glsl
        Segment s = segmentOf(r, along, 1.0, side);
        Horizon h = horizonAt(s.start);
        Bins bins = binsBelow(s.start);
        float edge = s.exit - 0.5, t = constants.first, step = constants.step;
        bool more = true;
        while (more) {
            vec2 to;  // from the receiver, metres times coverage
            float covered = 1.0;
            bool found = false;
            while (!found && more) {
                more = t < edge;
                float at = min(t, edge);
                float level = log2(max(width * at, 1.0));
                vec2 sampled;  // depth times coverage, coverage
                vec2 where = r.pixel + at * s.along;
                if (kThin != 0u) {
                    int mip = min(int(level + 0.5), int(constants.levels) - 1);
                    vec2 size = vec2(max(view.size >> mip, 1u));  // not halves: 27 rows are made of 54, and 13 of 27
                    sampled = texelFetch(pyramid, ivec2(min(where * texelSize * size, size - 0.5)), mip).xy;
                } else if (kLarger) {
                    float finer = min(floor(level), float(constants.levels) - 1.0);
                    int mip = int(finer), next = min(mip + 1, int(constants.levels) - 1);
                    sampled = mix(sampleOf(view, where * texelSize, mip), sampleOf(view, where * texelSize, next), level - finer);
                } else {
                    sampled = textureLod(pyramid, where * texelSize, level).xy;
                }
                covered = kThin != 0u ? 1.0 : sampled.y;
                to = seenAt(s, (sampled.x * s.scale.x + covered * s.scale.y) * at, sampled.x, covered);
                found = (kThin != 0u ? sampled.x > 0.0 : covered > 1e-3) && (kThin != 0u || raises(h, to));
                step *= growth;
                t += step;
            }
            vec2 point = kThin != 0u ? to : to / max(covered, 1e-6), slab = slabAt(s, point);
            if (kThin != 0u) addSlab(bins, point, normalize(slab), thick, found, s.n, metres);
            else raise(h, point, slab, vec2(0.0), 0.0, covered, found, s.n, metres);
        }
        sum += s.weight * vec2(kThin != 0u ? bins.sum : h.blocked, 1.0);
        along = next * along;
        if (++k >= constants.directions) break;
    }
    imageStore(visibility, p, vec4(clamp(1.0 - 2.0 * sum.x / sum.y, 0.0, 1.0)));
}
