// Visibility bitmask: a bit for each of 32 sectors of every slice of the hemisphere; samples of constant thickness set bits. Formulas:
// runtime/ao/methods/visibility_bitmask/visibility_bitmask.cpp. In and out: ao/common/slice.glsl; with BENT also raw bent normals.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant BENT
#include "ao/common/slice.glsl"
#include "ao/visibility_bitmask/constants.h"
#include "shared/falloff.h"
#ifdef BENT
#include "ao/common/bent_normals.glsl"
layout(set = 0, binding = 4, rg32ui) uniform writeonly uimage2D bentNormals;
#endif
layout(push_constant) uniform Block { VisibilityBitmaskSectors constants; };
layout(constant_id = 0) const bool kCosine = false;  // sectors have equal weight instead of equal angle

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    FalloffBlock rho = constants.falloff;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    float thick = constants.thickness;
    Receiver r;
    if (!receive(view, p, rho.reach, r)) {
#ifdef BENT
        imageStore(bentNormals, p, rawBent(view.skyDepth, vec3(0.0)));
#endif
        return;
    }

    float blocked = 0.0;
#ifdef BENT
    vec3 bentBlocked = vec3(0.0), bentWhole = vec3(0.0);
    float arcsBlocked = 0.0, arcsWhole = 0.0;
#endif
    for (uint k = 0u;;) {
        Slice slice = sliceAt(view, r, (float(k) + r.noise.x) * kPi / float(constants.slices), constants.rayAxis != 0u);
        float no = dot(r.n, slice.across), projected = sqrt(max(no * no + r.nv * r.nv, 1e-12)), sine = no / projected;
        float gamma = sign(no) * arcCosine(r.nv / projected);
        // Cosines of the hemisphere's edges on both sides, and the integral of each side.
        vec2 low = vec2(-sine, sine), whole = vec2(sliceArc(r.nv, no, low.x), sliceArc(r.nv, -no, low.y));
        float perSector = 32.0 / max(whole.x + whole.y, 1e-6), sum = 0.0;
        uint covered = 0u;
#ifdef BENT
        vec3 bent = vec3(0.0);
        float arcs = 0.0;
#endif
        for (uint i = 0u;;) {
            float t = samplePlace(r, k, i, constants.steps), l = t * t * r.radius + kTooClose;
            int level = levelAt(l, constants.mipOffset);
            vec2 offset = floor(l * slice.along + 0.5);
            for (int side = 0; side < 2; ++side) {
                vec3 d = toSurface(view, r, side == 0 ? r.pixel + offset : r.pixel - offset, level), b = d - thick * r.v;
                float inverse = inversesqrt(max(dot(d, d), 1e-20)), weight = falloff(rho, dot(d, d) * inverse);
                float front = dot(d, r.v) * inverse, back = dot(b, r.v) * inversesqrt(max(dot(b, b), 1e-20));
                ivec2 sectors;  // first sector and end, counted from the edge of side 1
                if (kCosine) {
                    float o = side == 0 ? no : -no;
                    vec2 arcs = vec2(sliceArc(r.nv, o, max(front, low[side])), sliceArc(r.nv, o, max(back, low[side])));
                    sectors = ivec2(clamp((whole.y + (side == 0 ? arcs : -arcs.yx)) * perSector, 0.0, 32.0) + 0.5);
                } else {
                    vec2 angles = vec2(arcCosine(front), arcCosine(back));
                    vec2 place = 32.0 * clamp(((side == 0 ? angles : -angles.yx) - gamma) / kPi + 0.5, 0.0, 1.0);
                    sectors = ivec2(place.x) + ivec2(0, ceil(place.y - place.x));
                }
                sectors = min(sectors, ivec2(31, 32));
                bool counts = weight > 0.0 && (!kCosine || dot(d, r.n) * inverse > 0.001);  // samples in the tangent plane cover nothing
                uint bits = counts ? bitfieldInsert(0u, ~0u, sectors.x, max(sectors.y - sectors.x, 0)) & ~covered : 0u;
                covered |= bits;
                sum += weight * float(bitCount(bits));
#ifdef BENT
                float o = side == 0 ? no : -no, from = max(front, low[side]), to = min(max(back, low[side]), from);
                float arc = max(sliceArc(r.nv, o, to) - sliceArc(r.nv, o, from), 0.0);
                // Of equal weight, a sector has the same part of the integral; of equal angle, its own part of the sample's.
                float part = weight * float(bitCount(bits)) * (kCosine ? 1.0 / perSector : arc / float(max(sectors.y - sectors.x, 1)));
                vec2 mean = part * meanBent(r.nv, o, from, to);
                bent += mean.x * r.v + (side == 0 ? mean.y : -mean.y) * slice.across;
                arcs += part;
#endif
            }
            if (++i >= constants.steps) break;
        }
        blocked += sum / 32.0 * (kCosine ? 0.5 * (whole.x + whole.y) : 1.0);
#ifdef BENT
        vec2 right = bentArc(r.nv, no, low.x), left = bentArc(r.nv, -no, low.y);
        bentWhole += (right.x + left.x) * r.v + (right.y - left.y) * slice.across;
        bentBlocked += bent;
        arcsBlocked += arcs;
        arcsWhole += whole.x + whole.y;
#endif
        if (++k >= constants.slices) break;
    }
#ifdef BENT
    float perSlice = 0.5 / float(constants.slices);
    vec3 bent = blockedBent(perSlice * bentBlocked, perSlice * bentWhole, r.n, 1.0 - arcsBlocked / max(arcsWhole, 1e-6));
    imageStore(bentNormals, p, rawBent(-r.here.z, bent));
#endif
    imageStore(noisy, p, uvec4(packNoisy(1.0 - blocked / float(constants.slices), r.edges)));
}
