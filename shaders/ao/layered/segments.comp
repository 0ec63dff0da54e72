// Segments of occlusion around each pixel: for every slice and step the depth layers there cover part of the hemisphere, each bit once,
// with the falloff at the covering segment. Formulas: runtime/ao/methods/layered/layered.cpp.
// In: normals and packed layers (one per texel; TWO_LAYERS: two; NO_LAYERS: depth, with an assumed thickness), guard band included.
// Out: shares (shares.glsl) of each image pixel or map pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant NO_LAYERS
#pragma variant TWO_LAYERS
#include "ao/common/packed_layers.glsl"
#include "ao/common/tile.glsl"
#include "ao/layered/constants.h"
#include "ao/layered/shares.glsl"
#include "ao/layered/sides.glsl"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, rg32ui) uniform writeonly uimage2D shares;
layout(push_constant) uniform Block { LayeredSegments constants; };

// Layers and normal (not normalised) of a pixel, which a texel of a coarser level is a copy of.
#if defined(NO_LAYERS)
layout(set = 0, binding = 2, r32f) uniform readonly image2D depth;
float depthAt(ivec2 pixel) { return imageLoad(depth, pixel).x; }
Layers layersAt(ivec2 pixel, ivec2 texel, float assumed, out vec3 normal) {
    normal = directionOf(imageLoad(normals, pixel).x);
    return Layers(depthAt(pixel), -abs(assumed), 0.0, 1.0);  // abs() lets the compiler drop the code for solids
}
#elif defined(TWO_LAYERS)
layout(set = 0, binding = 2, rgba32ui) uniform readonly uimage2D packedLayers;
float depthAt(ivec2 pixel) { return uintBitsToFloat(imageLoad(packedLayers, pixel).x); }
Layers layersAt(ivec2 pixel, ivec2 texel, float assumed, out vec3 normal) {
    uvec4 packed = imageLoad(packedLayers, texel);
    normal = normalOf(packed);
    return unpackLayers(packed);
}
#else
layout(set = 0, binding = 2, rg32ui) uniform readonly uimage2D packedLayers;
float depthAt(ivec2 pixel) { return uintBitsToFloat(imageLoad(packedLayers, pixel).x); }
Layers layersAt(ivec2 pixel, ivec2 texel, float assumed, out vec3 normal) {
    uvec2 packed = imageLoad(packedLayers, texel).xy;
    normal = normalOf(packed);
    return unpackFirstLayer(packed);
}
#endif

const float kAbove = 0.002;          // least sine of a sample above the tangent plane
const float kFlat = 0.1;             // sine of the largest angle between samples that are in one plane
const float kRise = 0.012;           // else: most that a surface is extended in depth over a stratum, in depths
const float kThin = 0.5;             // length of a thin object, in strata; 1 would be unbiased for round objects, but noisier
const float kNextStep = 0.61803399;  // shift of the samples from slice to slice

// Rotation of the slices and shift of the steps, in [0,1). Any 4x4 window contains all 16 values once, any 2x2 window one of each quarter.
// A hash has three times the error after the gather.
vec2 tileNoise(uvec2 p, uint side) {
    uint nine = p.x % 3u + 3u * (p.y % 3u), sixteen = bayer16(p);
    vec2 ranks = side == 3u ? vec2(nine, nine % 3u * 3u + nine / 3u) : vec2(sixteen, bitfieldReverse(sixteen) >> 28);
    return (ranks + 0.5) / (side == 3u ? 9.0 : 16.0);
}

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    FalloffBlock rho = constants.falloff;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(shares)))) return;
    ivec2 texel = pixelOfMap(p, constants.map, ivec2(view.visible)) + ivec2(view.guard), last = ivec2(view.size) - 1,
          padded = paddedSize(view.size);
    float z = depthAt(texel), thick = constants.assumed;
    if (isSky(view, z)) {
        imageStore(shares, p, uvec4(packShare(z, vec3(0.0, 0.0, 1.0), 0.0, 1.0), 0u, 0u));
        return;
    }
    bool orthographic = view.orthographic > 0.5;
    vec2 pixel = vec2(texel) + 0.5;
    vec3 position = eyePosition(view, pixel, z);
    Pixel here;
    here.ray = pixel * view.unproject.xy + view.unproject.zw;
    here.scale = orthographic ? 1.0 : z;
    here.perspective = orthographic ? 0.0 : 1.0;
    here.depth = z;
    here.v = towardsEye(view, position);
    here.n = unpackNormal(imageLoad(normals, texel).x);
    if (dot(here.n, here.v) < 0.0) here.n = -here.n;

    vec2 noise = fract(tileNoise(uvec2(p), constants.side) + frameShift(view).xy);
    float reach = min(rho.reach * view.pixelsPerMetre / here.scale, constants.maxPixels);
    vec3 tangent = normalize(vec3(1, 0, 0) - here.v * here.v.x), across = cross(tangent, here.v);
    float nv = dot(here.n, here.v), blocked = 0.0, measure = 0.0;
    // Loops are post-tested: lavapipe runs a pre-tested loop once more with every lane masked.
    for (uint k = 0u;;) {
        // Slices are evenly spaced around the view ray, not on the screen, so that they cover the hemisphere evenly.
        float turn = kPi * (float(k) + noise.x) / float(constants.slices);
        vec3 od = tangent * cos(turn) + across * sin(turn);
        vec2 step = (od.xy * here.scale + (orthographic ? vec2(0.0) : position.xy * od.z)) * view.project.xy;
        step *= inversesqrt(max(dot(step, step), 1e-20));
        vec2 stepRay = step * view.unproject.xy;
        float no = dot(here.n, od), angle = atan(no, nv);
        float sine = no * inversesqrt(max(no * no + nv * nv, 1e-12));
        float jitter = noise.y + kNextStep * float(k);
        for (uint halfIndex = 0u;;) {  // an integer counts, so that compilers know how often
            float sign = halfIndex == 0u ? 1.0 : -1.0;
            float whole = 0.5 * max(nv + angle * no + sign * 0.5 * kPi * no, 0.0);
            float scale = 16.0 / max(whole, 1e-6);
            Side state = Side(-sign * sine, nv * scale, sign * no * scale, 0u, 0.0, vec3(0.0), here.n, 1.0, 1.0);
            float place = fract(jitter + (sign > 0.0 ? 0.0 : 0.5));
            for (uint i = 0u;;) {
                float part = 1.0 / float(constants.steps), t0 = float(i) * part, t1 = t0 + part;
                float e0 = max(t0 * sqrt(t0) * reach, 1.0), e1 = max(t1 * sqrt(t1) * reach, 1.0);
                float t = t0 + place * part;
                float l = max(t * sqrt(t) * reach, 1.3);
                vec2 at = pixel + sign * l * step;
                bool inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(view.size)));
                int level = levelFor(l);
                ivec2 cell = clamp(ivec2(at), ivec2(0), last) >> level, q = pixelIn(cell, level, last);
                vec3 ns;
                Layers layers = layersAt(q, cell + mipTexel(padded, ivec2(0), level), thick, ns);
                Ray ray = rayAt(here, (vec2(q) + 0.5 - pixel) * view.unproject.xy);
                float zs = layers.first, f = zs - z;

                // The surface is extended in its tangent plane to both ends of the stratum, by at most its thickness in depth. It is
                // extended further only if the previous sample is in the same plane (facets of a relief would become spikes), and then back
                // to the end of that sample's surface. A sheet after a concave edge is extended back to the previous sample.
                vec3 d = vec3(ray.offset, 0.0) + f * ray.dir, from = d - state.previous;
                float off = dot(ns, from), plane = dot(ns, d);
                bool samePlane = off * off < kFlat * kFlat * dot(ns, ns) * dot(from, from);
                bool concave = off < 0.0 && dot(state.previousNormal, from) > 0.0 && layers.firstLength < 0.0;
                Ray ray0 = rayAt(here, sign * min(samePlane ? state.previousEnd : concave ? state.previousAt : e0, l) * stepRay),
                    ray1 = rayAt(here, sign * max(e1, l) * stepRay);
                float maxRise = (samePlane ? 0.5 : kRise) * zs;
                maxRise = layers.firstLength > 0.0 ? min(layers.firstLength, maxRise) : maxRise;
                float maxRise0 = concave ? 0.5 * zs : maxRise;
                float f0 = clamp((plane - dot(ns.xy, ray0.offset)) / min(dot(ns, ray0.dir), -1e-4), f - maxRise0, f + maxRise0);
                float end = (plane - dot(ns.xy, ray1.offset)) / min(dot(ns, ray1.dir), -1e-4), f1 = clamp(end, f - maxRise, f + maxRise);
                state.previous = inside ? d : state.previous;
                state.previousNormal = inside ? ns : state.previousNormal;
                state.previousAt = inside ? l : state.previousAt;
                state.previousEnd = inside ? (f1 == end ? max(e1, l) : l) : state.previousEnd;
                float nearest = concave ? abs(plane) * inversesqrt(max(dot(ns, ns), 1e-20)) : 1e9;
                // A solid thinner than its stratum is rarely hit; a hit is lengthened to compensate for the misses.
                float least = abs(from.z) > layers.firstLength ? kThin * length(ray1.offset - ray0.offset) : 0.0;
                bool above = dot(d, here.n) > kAbove * length(d);  // samples in the tangent plane cover nothing
                coverLayer(state, rho, ray0, ray, ray1, f0, f, f1, layers.firstLength, nearest, least, inside && above && !isSky(view, zs));
#ifdef TWO_LAYERS
                float g = layers.second - z;
                vec3 b = vec3(ray.offset, 0.0) + g * ray.dir;
                bool secondAbove = dot(b, here.n) > kAbove * length(b);
                coverLayer(
                    state, rho, ray0, ray, ray1, g, g, g, layers.secondLength, 1e9, 0.0, inside && secondAbove && layers.second > 0.0);
#endif
                if (++i >= constants.steps) break;
            }
            blocked += state.blocked * whole;
            measure += whole;
            if (++halfIndex >= 2u) break;
        }
        if (++k >= constants.slices) break;
    }
    float sliceCount = float(constants.slices);
    imageStore(shares, p, uvec4(packShare(z, here.n, blocked / (32.0 * sliceCount), measure / sliceCount), 0u, 0u));
}
