// Segments of occlusion around each pixel: in each slice every sample covers the angles between the front and the back of what it hits,
// each bit once, with the falloff at its nearest point. Formulas: runtime/ao/methods/layered/layered.cpp.
// In: normals and packed layers (one per texel; TWO_LAYERS: two; NO_LAYERS: depth, with an assumed thickness), guard band included.
// Out: shares (shares.glsl) of each image pixel or map pixel; with BENT also their raw bent normals.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant NO_LAYERS
#pragma variant TWO_LAYERS
#pragma variant BENT
#pragma variant NO_LAYERS,BENT
#pragma variant TWO_LAYERS,BENT
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
#ifdef BENT
layout(set = 0, binding = 4, rg32ui) uniform writeonly uimage2D bentNormals;
#endif
layout(push_constant) uniform Block { LayeredSegments constants; };

// Layers of a pixel, and the texel that is a copy of it.
#if defined(NO_LAYERS)
layout(set = 0, binding = 2, r32f) uniform readonly image2D depth;
float depthAt(ivec2 pixel) { return imageLoad(depth, pixel).x; }
Layers layersAt(ivec2 pixel, ivec2 texel) { return Layers(depthAt(pixel), -constants.assumed, 0.0, 0.0, 0.0); }
#elif defined(TWO_LAYERS)
layout(set = 0, binding = 2, rgba32ui) uniform readonly uimage2D packedLayers;
float depthAt(ivec2 pixel) { return uintBitsToFloat(imageLoad(packedLayers, pixel).x); }
Layers layersAt(ivec2 pixel, ivec2 texel) { return unpackLayers(imageLoad(packedLayers, texel)); }
#else
layout(set = 0, binding = 2, rg32ui) uniform readonly uimage2D packedLayers;
float depthAt(ivec2 pixel) { return uintBitsToFloat(imageLoad(packedLayers, pixel).x); }
Layers layersAt(ivec2 pixel, ivec2 texel) { return unpackFirstLayer(imageLoad(packedLayers, texel).xy); }
#endif

const float kNextStep = 0.61803399;  // shift of the samples from slice to slice
const float kTooClose = 1.3;         // px: nearer samples are the pixel itself

// Rotation of the slices and shift of the steps, in [0,1), for each pixel of the tile. The gather averages exactly one tile. A hash has
// three times the error after the gather.
vec2 tileNoise(uvec2 p, uint side) {
    uint nine = p.x % 3u + 3u * (p.y % 3u), four = bayer(p), sixteen = bayer16(p);
    vec2 ranks = side == 3u   ? vec2(nine, nine % 3u * 3u + nine / 3u)
                 : side == 2u ? vec2(four, bitfieldReverse(four) >> 30)
                              : vec2(sixteen, bitfieldReverse(sixteen) >> 28);
    return (ranks + 0.5) / (side == 3u ? 9.0 : side == 2u ? 4.0 : 16.0);
}

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    FalloffBlock rho = constants.falloff;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, constants.size))) return;
    ivec2 texel = pixelOfMap(p, constants.map, ivec2(view.visible)) + ivec2(view.guard);
    if (isSky(view, depthAt(texel))) {
        imageStore(shares, p, packShare(depthAt(texel), 0.0, 1.0));
#ifdef BENT
        imageStore(bentNormals, p, rawBent(depthAt(texel), vec3(0.0)));
#endif
        return;
    }
    vec2 noise = fract(tileNoise(uvec2(p), constants.side) + frameShift(view).xy);
    bool orthographic = view.orthographic > 0.5;
    ivec2 padded = paddedSize(view.size);
    float sliceCount = float(constants.slices), stratum = 1.0 / float(constants.steps), blocked = 0.0, whole = 0.0;
#ifdef BENT
    vec3 bentBlocked = vec3(0.0), bentWhole = vec3(0.0);
#endif
    // Loops are post-tested: lavapipe runs a pre-tested loop once more with every lane masked.
    for (uint k = 0u;;) {
        // The receiver is computed for each slice again, because the registers that it would take cost more.
        float z = depthAt(texel);
        vec2 pixel = vec2(texel) + 0.5;
        vec3 position = eyePosition(view, pixel, z), v = towardsEye(view, position), n = unpackNormal(imageLoad(normals, texel).x);
        n = dot(n, v) < 0.0 ? -n : n;
        float perMetre = orthographic ? 1.0 : z, reach = min(rho.reach * view.pixelsPerMetre / perMetre, constants.maxPixels);

        // Slices are evenly spaced around the view ray, not on the screen, so that they cover the hemisphere evenly.
        vec3 tangent = normalize(vec3(1, 0, 0) - v * v.x), across = cross(tangent, v);
        float turn = kPi * (float(k) + noise.x) / sliceCount;
        vec3 od = tangent * cos(turn) + across * sin(turn);
        vec2 step = od.xy * perMetre + (orthographic ? vec2(0.0) : position.xy * od.z);
        step *= inversesqrt(max(dot(step, step), 1e-20)) * view.project.xy / view.pixelsPerMetre;  // as long as a pixel is high
        Receiver receiver = receiverOf(view, pixel, z, v, n, od, step);
        float nv = dot(n, v), no = dot(n, od), angle = atan(no, nv), sine = no * inversesqrt(max(no * no + nv * nv, 1e-12));
        // Distances to the buffers' edges along the step and against it, px.
        vec2 inverse = 1.0 / max(abs(step), vec2(1e-6)), low = (pixel - 0.5) * inverse, high = (vec2(view.size) - 0.5 - pixel) * inverse;
        bvec2 rising = greaterThan(step, vec2(0.0));
        vec2 ahead = mix(low, high, rising), behind = mix(high, low, rising);
        float place = fract(noise.y + kNextStep * float(k));
        for (uint halfIndex = 0u;;) {  // an integer counts, so that compilers know how often
            float sign = halfIndex == 0u ? 1.0 : -1.0;
            vec2 edges = halfIndex == 0u ? ahead : behind;
            float farthest = min(edges.x, edges.y), own = 0.5 * max(nv + angle * no + sign * 0.5 * kPi * no, 0.0);
            Side side = sideOf(nv, sign * no, -sign * sine, own);
            float end = 1.0;
            for (uint i = 0u;;) {
                float t = (float(i) + place) * stratum, l = max(t * t * reach, kTooClose), start = end;
                t = float(i + 1u) * stratum;
                end = max(t * t * reach, 1.0);
                Plate plate = plateOf(l, start, end);
                ivec2 at = ivec2(pixel + sign * min(l, farthest) * step);
                int level = levelFor(l);
                ivec2 copied = copiedPixel(at, level);
                Layers layers = layersAt(copied, mipTexelOfSample(padded, at, level));
                Aside aside = asideOf(receiver, vec2(copied) + 0.5 - pixel, sign);
                cover(side, receiver, rho, plate, aside, layers.first, layers.first - z, layers.firstLength, layers.steepest,
                    l < farthest && !isSky(view, layers.first), true);
#ifdef TWO_LAYERS
                cover(side, receiver, rho, plate, aside, layers.second, layers.second - z, layers.secondLength, 0.0,
                    l < farthest && layers.second > 0.0, false);
#endif
                if (++i >= constants.steps) break;
            }
            blocked += side.blocked * own;
            whole += own;
#ifdef BENT
            vec2 bent = side.bent * own, all = 0.5 * bentArc(nv, sign * no, -sign * sine);
            bentBlocked += bent.x * v + bent.y * sign * od;
            bentWhole += all.x * v + all.y * sign * od;
#endif
            if (++halfIndex >= 2u) break;
        }
        if (++k >= constants.slices) break;
    }
#ifdef BENT
    vec3 eye = eyePosition(view, vec2(texel) + 0.5, depthAt(texel)), normal = unpackNormal(imageLoad(normals, texel).x);
    normal = dot(normal, towardsEye(view, eye)) < 0.0 ? -normal : normal;
    vec3 result = blockedBent(bentBlocked / (32.0 * sliceCount), bentWhole / sliceCount, normal, 1.0 - blocked / max(32.0 * whole, 1e-6));
    imageStore(bentNormals, p, rawBent(depthAt(texel), result));
#endif
    imageStore(shares, p, packShare(depthAt(texel), blocked / (32.0 * sliceCount), whole / sliceCount));
}
