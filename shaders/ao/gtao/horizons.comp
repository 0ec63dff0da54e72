// GTAO: two horizons for each slice of the hemisphere and the closed-form visibility between them. Formulas:
// runtime/ao/methods/gtao/gtao.cpp. In and out: ao/common/slice.glsl; with DEPTH_LAYERS also packed layers with their own coarser levels,
// and `depths` has level 0 only; with BENT also raw bent normals.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant DEPTH_LAYERS
#pragma variant BENT
#pragma variant DEPTH_LAYERS,BENT
#include "ao/common/slice.glsl"
#include "ao/gtao/constants.h"
#include "shared/falloff.h"
#ifdef DEPTH_LAYERS
#include "ao/common/layer_sample.glsl"
layout(set = 0, binding = 4, rgba32ui) uniform readonly uimage2D packedLayers;
#define BENT_BINDING 5
#else
#define BENT_BINDING 4
#endif
#ifdef BENT
#include "ao/common/bent_normals.glsl"
layout(set = 0, binding = BENT_BINDING, rg32ui) uniform writeonly uimage2D bentNormals;
#endif
layout(push_constant) uniform Block { GtaoHorizons constants; };
layout(constant_id = 0) const bool kArcs = false;

#ifdef DEPTH_LAYERS
// One side of a slice, from the edge of the hemisphere to the eye: a mask of 32 intervals of equal weight; each is blocked once.
struct Side {
    float nv, no, low, whole;  // low: cosine at the hemisphere's edge; whole: sliceArc of low
    uint covered;
    float blocked;             // 32nds
    vec3 previous;             // the previous sample's front, from the pixel
    float previousCosine;
#ifdef BENT
    vec2 bent;                 // of what is blocked, as bentArc()
#endif
};
float placeAt(Side side, float c) { return clamp(32.0 - 32.0 * sliceArc(side.nv, side.no, max(c, side.low)) / side.whole, 0.0, 32.0); }
// A layer blocks from its front (cosine c) to its back, or down to `down`, the previous sample of its plane. With kArcs the newly covered
// intervals have the falloff as weight; else the falloff mixes both ends towards the hemisphere's edge. d: its front, from the pixel; ray:
// the view ray per metre of depth; size: its packed length.
void coverLayer(inout Side side, FalloffBlock rho, vec3 v, vec3 d, vec3 ray, float size, float c, float down, bool counts) {
    float weight = falloff(rho, layerDistance(d, ray, size)), back = min(backCosine(d, ray, size, v), down);
    float upper = kArcs ? c : mix(side.low, c, weight), lower = kArcs ? back : mix(side.low, max(back, side.low), weight);
    uint bits = counts ? bitsBetween(placeAt(side, lower), placeAt(side, upper)) & ~side.covered : 0u;
    side.covered |= bits;
    side.blocked += (kArcs ? weight : 1.0) * float(bitCount(bits));
#ifdef BENT
    float part = (kArcs ? weight : 1.0) * float(bitCount(bits)) / 32.0 * side.whole;
    side.bent += part * meanBent(side.nv, side.no, max(upper, side.low), clamp(lower, side.low, max(upper, side.low)));
#endif
}
#endif

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    FalloffBlock rho = constants.falloff;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    Receiver r;
    if (!receive(view, p, rho.reach, r)) {
#ifdef BENT
        imageStore(bentNormals, p, rawBent(view.skyDepth, vec3(0.0)));
#endif
        return;
    }

    float open = kArcs ? 0.0 : clamp((10.0 - r.radius) / 100.0, 0.0, 1.0) * 0.5;  // fades out where the reach is a few pixels
    float blocked = 0.0;
#ifdef BENT
    vec3 bentBlocked = vec3(0.0), bentWhole = vec3(0.0);
    float arcsBlocked = 0.0, arcsWhole = 0.0;
#endif
    for (uint k = 0u;;) {
        Slice slice = sliceAt(view, r, (float(k) + r.noise.x) * kPi / float(constants.slices), constants.rayAxis != 0u);
        float no = dot(r.n, slice.across), squared = max(no * no + r.nv * r.nv, 1e-12), inverseLength = inversesqrt(squared),
              projected = squared * inverseLength, sine = no * inverseLength;
        vec2 low = vec2(-sine, sine);  // cosines of gamma +- pi/2, the hemisphere's edges
#ifdef DEPTH_LAYERS
        Side halves[2];
        for (int side = 0; side < 2; ++side) {
            float toSide = side == 0 ? no : -no;
            halves[side] = Side(r.nv, toSide, low[side], max(sliceArc(r.nv, toSide, low[side]), 1e-6), 0u, 0.0, vec3(0.0), 1.0
#ifdef BENT
                , vec2(0.0)
#endif
            );
        }
#endif
        vec2 horizon = low, covered = vec2(0.0);
        vec2 before = kArcs ? vec2(sliceArc(r.nv, no, low.x), sliceArc(r.nv, -no, low.y)) : vec2(0.0);
#ifdef BENT
        vec2 bentLow[2] = vec2[](bentArc(r.nv, no, low.x), bentArc(r.nv, -no, low.y));
        vec2 bentBefore[2] = bentLow, bentCovered[2] = vec2[](vec2(0.0), vec2(0.0));
        vec2 wholes = vec2(sliceArc(r.nv, no, low.x), sliceArc(r.nv, -no, low.y));
#endif
        for (uint i = 0u;;) {
            float t = samplePlace(r, k, i, constants.steps), l = t * t * r.radius + kTooClose;  // denser near the pixel
            int level = levelAt(l, constants.mipOffset);
            vec2 offset = floor(l * slice.along + 0.5);
            for (int side = 0; side < 2; ++side) {
#ifdef DEPTH_LAYERS
                vec2 at = side == 0 ? r.pixel + offset : r.pixel - offset;
                bool inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(view.size)));
                ivec2 q = clamp(ivec2(at), ivec2(0), r.last);
                uvec4 texel = imageLoad(packedLayers, mipTexel(r.padded, q, level));
                q = copiedPixel(q, level);
                LayerSample s = layerSampleAt(view, texel, q, r.here, r.n, r.v, halves[side].previous);
                coverLayer(halves[side], rho, r.v, s.first, s.ray, s.layers.firstLength, s.cosines.x,
                    s.joined ? halves[side].previousCosine : 1.0, inside && s.heights.x > 0.001);
                coverLayer(halves[side], rho, r.v, s.second, s.ray, s.layers.secondLength, s.cosines.y, 1.0,
                    inside && s.layers.second > 0.0 && s.heights.y > 0.001);
                halves[side].previous = inside ? s.first : halves[side].previous;
                halves[side].previousCosine = inside ? s.cosines.x : halves[side].previousCosine;
#else
                vec3 d = toSurface(view, r, side == 0 ? r.pixel + offset : r.pixel - offset, level);
                float inverse = inversesqrt(max(dot(d, d), 1e-20)), weight = falloff(rho, dot(d, d) * inverse), c = dot(d, r.v) * inverse;
                if (kArcs) {
                    bool raised = c > horizon[side] && dot(d, r.n) * inverse > 0.001;  // samples in the tangent plane raise nothing
                    float now = sliceArc(r.nv, side == 0 ? no : -no, c);
                    covered[side] += raised ? weight * (before[side] - now) : 0.0;
                    before[side] = raised ? now : before[side];
#ifdef BENT
                    vec2 bentNow = bentArc(r.nv, side == 0 ? no : -no, max(c, low[side]));
                    bentCovered[side] += raised ? weight * (bentBefore[side] - bentNow) : vec2(0.0);
                    bentBefore[side] = raised ? bentNow : bentBefore[side];
#endif
                    horizon[side] = raised ? c : horizon[side];
                } else {
                    horizon[side] = max(horizon[side], mix(low[side], c, weight));
                }
#endif
            }
            if (++i >= constants.steps) break;
        }
#ifdef DEPTH_LAYERS
        covered = vec2(halves[0].blocked * halves[0].whole, halves[1].blocked * halves[1].whole) / 32.0;
        float arcs = halves[0].whole + halves[1].whole - covered.x - covered.y;
#else
        float arcs = kArcs ? 0.0 : sliceArc(r.nv, no, horizon.x) + sliceArc(r.nv, -no, horizon.y);
#endif
        if (!kArcs) open += mix(projected, 1.0, 0.05) * 0.5 * inverseLength * arcs;
        blocked += covered.x + covered.y;
#ifdef BENT
#ifdef DEPTH_LAYERS
        bentCovered[0] = halves[0].bent;
        bentCovered[1] = halves[1].bent;
        arcsBlocked += covered.x + covered.y;
#else
        if (!kArcs) {
            bentCovered[0] = bentLow[0] - bentArc(r.nv, no, horizon.x);
            bentCovered[1] = bentLow[1] - bentArc(r.nv, -no, horizon.y);
        }
        arcsBlocked += kArcs ? covered.x + covered.y : wholes.x + wholes.y - arcs;
#endif
        arcsWhole += wholes.x + wholes.y;
        bentBlocked += (bentCovered[0].x + bentCovered[1].x) * r.v + (bentCovered[0].y - bentCovered[1].y) * slice.across;
        bentWhole += (bentLow[0].x + bentLow[1].x) * r.v + (bentLow[0].y - bentLow[1].y) * slice.across;
#endif
        if (++k >= constants.slices) break;
    }
    float visibility = max(kArcs ? 1.0 - 0.5 * blocked / float(constants.slices) : open / float(constants.slices), 0.0);
    visibility = constants.power == 1.0 ? visibility : pow(visibility, constants.power);
#ifdef BENT
    float perSlice = 0.5 / float(constants.slices);
    vec3 bent = blockedBent(perSlice * bentBlocked, perSlice * bentWhole, r.n, 1.0 - arcsBlocked / max(arcsWhole, 1e-6));
    imageStore(bentNormals, p, rawBent(-r.here.z, bent));
#endif
    imageStore(noisy, p, uvec4(packNoisy(max(visibility, constants.least), r.edges)));
}
