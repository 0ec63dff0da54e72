// Segments of occlusion around each pixel: for every slice and step what the depth layers hold there covers part of the
// hemisphere, once, with the falloff of where it stands. Formulas in runtime/ao/methods/layered.cpp.
// In: normals and spans (one of matter, with TWO_SPANS two; with NO_SPANS depth, and all is as thick as assumed), guard band included.
// Out: what they block and what they could, of each pixel or, with a map, of some (parts.glsl).
#ifndef OBSCURA_SEGMENTS_GLSL
#define OBSCURA_SEGMENTS_GLSL
#include "ao/common/spans.glsl"
#include "ao/common/tile.glsl"
#include "ao/layered/parts.glsl"
#include "ao/layered/sides.glsl"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, rg32ui) uniform writeonly uimage2D parts;
layout(push_constant) uniform Constants {
    FalloffBlock falloffBlock;
    uint slices;    // of this pixel
    uint steps;     // a side
    float maxPixels;
    uint side;      // of the tile whose pixels share the slices out
    uint map;       // pixels that one of these stands for, each way
    float assumed;  // thickness of everything where there are no layers, metres
};

// What there is at a pixel, which a texel of a coarser level holds: its matter and, of any length, its normal.
#if defined(NO_SPANS)
layout(set = 0, binding = 2, r32f) uniform readonly image2D depth;
float depthAt(ivec2 pixel) { return imageLoad(depth, pixel).x; }
Spans matterAt(ivec2 pixel, ivec2 texel, float assumed, out vec3 normal) {
    normal = directionOf(imageLoad(normals, pixel).x);
    return Spans(depthAt(pixel), -abs(assumed), 0.0, 1.0);  // abs tells compilers the sign: nothing is solid
}
#elif defined(TWO_SPANS)
layout(set = 0, binding = 2, rgba32ui) uniform readonly uimage2D spans;
float depthAt(ivec2 pixel) { return uintBitsToFloat(imageLoad(spans, pixel).x); }
Spans matterAt(ivec2 pixel, ivec2 texel, float assumed, out vec3 normal) {
    uvec4 packed = imageLoad(spans, texel);
    normal = normalOf(packed);
    return unpackSpans(packed);
}
#else
layout(set = 0, binding = 2, rg32ui) uniform readonly uimage2D spans;
float depthAt(ivec2 pixel) { return uintBitsToFloat(imageLoad(spans, pixel).x); }
Spans matterAt(ivec2 pixel, ivec2 texel, float assumed, out vec3 normal) {
    uvec2 packed = imageLoad(spans, texel).xy;
    normal = normalOf(packed);
    return unpackSpan(packed);
}
#endif

const float kAbove = 0.002;          // sine above the pixel's own plane from which on things cover it
const float kFlat = 0.1;             // sine of the angle up to which two samples share a plane
const float kRise = 0.012;           // depths that a surface may rise over a stratum when they do not
const float kThin = 0.5;             // of a stratum's length: what a thin thing in it counts for; 1 would be right for the round, and noisier
const float kNextStep = 0.61803399;  // slices do not sample in one rhythm

// Which of the tile's slices and steps are a pixel's, in [0,1). Any 4x4 pixels hold 16 once, any 2x2 of them a quarter each: a hash
// instead has three times the error after the gather.
vec2 tileNoise(uvec2 p, uint side) {
    uint nine = p.x % 3u + 3u * (p.y % 3u), sixteen = bayer16(p);
    vec2 ranks = side == 3u ? vec2(nine, nine % 3u * 3u + nine / 3u) : vec2(sixteen, bitfieldReverse(sixteen) >> 28);
    return (ranks + 0.5) / (side == 3u ? 9.0 : 16.0);
}

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    FalloffBlock rho = falloffBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(parts)))) return;
    ivec2 texel = pixelOfMap(p, map, ivec2(view.visible)) + ivec2(view.guard), last = ivec2(view.size) - 1, padded = paddedSize(view.size);
    float z = depthAt(texel), thick = assumed;
    if (isSky(view, z)) {
        imageStore(parts, p, uvec4(packPart(z, vec3(0.0, 0.0, 1.0), 0.0, 1.0), 0u, 0u));
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

    vec2 noise = fract(tileNoise(uvec2(p), side) + frameShift(view).xy);
    float reach = min(rho.reach * view.pixelsPerMetre / here.scale, maxPixels);
    vec3 tangent = normalize(vec3(1, 0, 0) - here.v * here.v.x), across = cross(tangent, here.v);
    float nv = dot(here.n, here.v), blocked = 0.0, measure = 0.0;
    // Loops end with their test: where they begin with it, lavapipe runs their bodies once more for nothing.
    uint k = 0u;
    while (true) {
        // Slices lie evenly around the view ray, not on the screen: only then they make up the hemisphere.
        float turn = kPi * (float(k) + noise.x) / float(slices);
        vec3 od = tangent * cos(turn) + across * sin(turn);
        vec2 step = (od.xy * here.scale + (orthographic ? vec2(0.0) : position.xy * od.z)) * view.project.xy;
        step *= inversesqrt(max(dot(step, step), 1e-20));
        vec2 stepRay = step * view.unproject.xy;
        float no = dot(here.n, od), angle = atan(no, nv);
        float sine = no * inversesqrt(max(no * no + nv * nv, 1e-12));
        float jitter = noise.y + kNextStep * float(k);
        float sign = 1.0;
        while (true) {
            float whole = 0.5 * max(nv + angle * no + sign * 0.5 * kPi * no, 0.0);
            float scale = 16.0 / max(whole, 1e-6);
            Side half_ = Side(-sign * sine, nv * scale, sign * no * scale, 0u, 0.0, vec3(0.0), here.n, 1.0, 1.0);
            float place = fract(jitter + (sign > 0.0 ? 0.0 : 0.5));
            uint i = 0u;
            while (true) {
                float part = 1.0 / float(steps), t0 = float(i) * part, t1 = t0 + part;
                float e0 = max(t0 * sqrt(t0) * reach, 1.0), e1 = max(t1 * sqrt(t1) * reach, 1.0);
                float t = t0 + place * part;
                float l = max(t * sqrt(t) * reach, 1.3);
                vec2 at = pixel + sign * l * step;
                bool inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(view.size)));
                int level = levelFor(l);
                ivec2 cell = clamp(ivec2(at), ivec2(0), last) >> level, q = pixelIn(cell, level, last);
                vec3 ns;
                Spans matter = matterAt(q, cell + mipTexel(padded, ivec2(0), level), thick, ns);
                Ray ray = rayAt(here, (vec2(q) + 0.5 - pixel) * view.unproject.xy);
                float zs = matter.first, f = zs - z;

                // The surface goes on in its tangent plane to both ends of the stratum, as far as it is thick. Far only where the
                // sample before lies in that plane too, for the facets of a relief would rise as spikes; then what that sample
                // was not followed over is made up for. A sheet that rises out of a hollow fills it: nothing is seen between.
                vec3 d = vec3(ray.offset, 0.0) + f * ray.dir, from = d - half_.before;
                float off = dot(ns, from), plane = dot(ns, d);
                bool flat_ = off * off < kFlat * kFlat * dot(ns, ns) * dot(from, from);
                bool hollow = off < 0.0 && dot(half_.faced, from) > 0.0 && matter.firstLength < 0.0;
                Ray ray0 = rayAt(here, sign * min(flat_ ? half_.reached : hollow ? half_.at : e0, l) * stepRay), ray1 = rayAt(here, sign * max(e1, l) * stepRay);
                float most = (flat_ ? 0.5 : kRise) * zs;
                most = matter.firstLength > 0.0 ? min(matter.firstLength, most) : most;
                float most0 = hollow ? 0.5 * zs : most;
                float f0 = clamp((plane - dot(ns.xy, ray0.offset)) / min(dot(ns, ray0.dir), -1e-4), f - most0, f + most0);
                float end = (plane - dot(ns.xy, ray1.offset)) / min(dot(ns, ray1.dir), -1e-4), f1 = clamp(end, f - most, f + most);
                half_.before = inside ? d : half_.before;
                half_.faced = inside ? ns : half_.faced;
                half_.at = inside ? l : half_.at;
                half_.reached = inside ? (f1 == end ? max(e1, l) : l) : half_.reached;
                float nearest = hollow ? abs(plane) * inversesqrt(max(dot(ns, ns), 1e-20)) : 1e9;
                // What is thinner than its stratum is long is seldom hit, and then stands for all the misses.
                float least = abs(from.z) > matter.firstLength ? kThin * length(ray1.offset - ray0.offset) : 0.0;
                bool above = dot(d, here.n) > kAbove * length(d);  // the pixel's own plane covers nothing
                span(half_, rho, ray0, ray, ray1, f0, f, f1, matter.firstLength, nearest, least, inside && above && !isSky(view, zs));
#ifdef TWO_SPANS
                float g = matter.second - z;
                vec3 b = vec3(ray.offset, 0.0) + g * ray.dir;
                bool behind = dot(b, here.n) > kAbove * length(b);
                span(half_, rho, ray0, ray, ray1, g, g, g, matter.secondLength, 1e9, 0.0, inside && behind && matter.second > 0.0);
#endif
                if (++i >= steps) break;
            }
            blocked += half_.blocked * whole;
            measure += whole;
            if (sign < 0.0) break;
            sign = -1.0;
        }
        if (++k >= slices) break;
    }
    imageStore(parts, p, uvec4(packPart(z, here.n, blocked / (32.0 * float(slices)), measure / float(slices)), 0u, 0u));
}

#endif
