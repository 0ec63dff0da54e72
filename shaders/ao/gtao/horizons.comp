// Two horizons for each slice of the hemisphere, and what is open between them in closed form. Formulas in runtime/ao/methods/gtao.cpp.
// In and out: ao/common/slice.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/slice.glsl"
#include "shared/falloff.h"
layout(push_constant) uniform Constants {
    FalloffBlock falloffBlock;
    uint slices;
    uint steps;       // a side
    float mipOffset;  // log2 of px up to which level 0 is read
    float power;      // of visibility
    float least;      // visibility
    uint rayAxis;     // slices lie evenly 0: on the screen, 1: around the view ray
};
layout(constant_id = 0) const bool kArcs = false;

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    FalloffBlock rho = falloffBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    Receiver r;
    if (!receive(view, p, rho.reach, r)) return;

    float open = kArcs ? 0.0 : clamp((10.0 - r.radius) / 100.0, 0.0, 1.0) * 0.5;  // a fade where the reach is a few pixels
    float blocked = 0.0;
    for (uint k = 0u;;) {
        Slice slice = sliceAt(view, r, (float(k) + r.noise.x) * kPi / float(slices), rayAxis != 0u);
        float no = dot(r.n, slice.across), projected = sqrt(max(no * no + r.nv * r.nv, 1e-12)), sine = no / projected;
        vec2 low = vec2(-sine, sine);  // cosines of gamma +- pi/2: where the hemisphere ends
        vec2 horizon = low, covered = vec2(0.0);
        vec2 before = kArcs ? vec2(sliceArc(r.nv, no, low.x), sliceArc(r.nv, -no, low.y)) : vec2(0.0);
        for (uint i = 0u;;) {
            float t = placeOf(r, k, i, steps), l = t * t * r.radius + kTooClose;  // denser near the pixel
            int level = levelAt(l, mipOffset);
            vec2 offset = floor(l * slice.along + 0.5);
            for (int side = 0; side < 2; ++side) {
                vec3 d = towards(view, r, side == 0 ? r.pixel + offset : r.pixel - offset, level);
                float inverse = inversesqrt(max(dot(d, d), 1e-20)), weight = falloff(rho, dot(d, d) * inverse), c = dot(d, r.v) * inverse;
                if (kArcs) {
                    bool raised = c > horizon[side] && dot(d, r.n) * inverse > 0.001;  // texels of the pixel's own plane raise nothing
                    float now = sliceArc(r.nv, side == 0 ? no : -no, c);
                    covered[side] += raised ? weight * (before[side] - now) : 0.0;
                    before[side] = raised ? now : before[side];
                    horizon[side] = raised ? c : horizon[side];
                } else {
                    horizon[side] = max(horizon[side], mix(low[side], c, weight));
                }
            }
            if (++i >= steps) break;
        }
        if (kArcs) {
            blocked += covered.x + covered.y;
        } else {
            float gamma = sign(no) * arcCosine(r.nv / projected);
            float h0 = -arcCosine(horizon.y), h1 = arcCosine(horizon.x);
            float arcs = 2.0 * cos(gamma) + 2.0 * (h0 + h1) * sin(gamma) - cos(2.0 * h0 - gamma) - cos(2.0 * h1 - gamma);
            open += mix(projected, 1.0, 0.05) * 0.25 * arcs;
        }
        if (++k >= slices) break;
    }
    float visibility = max(kArcs ? 1.0 - 0.5 * blocked / float(slices) : open / float(slices), 0.0);
    imageStore(noisy, p, uvec4(packNoisy(max(power == 1.0 ? visibility : pow(visibility, power), least), r.edges)));
}
