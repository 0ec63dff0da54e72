// HBAO, one invocation per visible pixel, directions x steps nearest-texel samples. Formulas: runtime/ao/methods/hbao/hbao.cpp.
// In: linear depth, packed normals, guard band included; with DEPTH_LAYERS, packed layers. Out: visibility, R16F; with BENT also raw bent
// normals.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant DEPTH_LAYERS
#pragma variant BENT
#pragma variant DEPTH_LAYERS,BENT
#include "ao/common/pixel_shape.glsl"
#include "ao/common/tile.glsl"
#include "ao/hbao/constants.h"
#include "shared/falloff.h"
#include "shared/octahedral.glsl"
#include "shared/view.h"
#ifdef DEPTH_LAYERS
#include "ao/common/layer_sample.glsl"
#endif
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, r16f) uniform writeonly image2D visibility;
#ifdef DEPTH_LAYERS
layout(set = 0, binding = 4, rgba32ui) uniform readonly uimage2D packedLayers;
#define BENT_BINDING 5
#else
#define BENT_BINDING 4
#endif
#ifdef BENT
#include "ao/common/bent_normals.glsl"
layout(set = 0, binding = BENT_BINDING, rg32ui) uniform writeonly uimage2D bentNormals;
#endif
layout(push_constant) uniform Block { HbaoHorizons constants; };

const float kTwoPi = 6.28318531;

// Two permutations of 0..15 over a 4x4 tile: rotation and step offset, (i + 0.5) / 16.
const float kRotation[16] = float[](0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5);
const float kOffset[16] = float[](5, 13, 7, 15, 9, 1, 11, 3, 6, 14, 4, 12, 10, 2, 8, 0);

// Sine of the elevation of the tangent plane in a direction on the screen, measured from the plane perpendicular to v: of the point where
// the view ray of the next pixel intersects the tangent plane.
float tangentSine(View view, vec3 here, vec3 n, vec3 v, vec2 pixel, vec2 direction) {
    vec3 ahead = eyePosition(view, pixel + direction, -here.z);
    vec3 t;
    if (view.orthographic > 0.5) {
        vec3 d = ahead - here;
        t = d - vec3(0, 0, 1) * dot(n, d) / max(n.z, 1e-3);
    } else {
        float facing = dot(n, ahead);
        t = abs(facing) > 1e-6 ? ahead * (dot(n, here) / facing) - here : ahead;
        if (facing * dot(n, here) <= 0.0) t = -v;  // no intersection: the plane falls away behind the horizon
    }
    return dot(t, v) * inversesqrt(max(dot(t, t), 1e-20));
}

#ifdef DEPTH_LAYERS
// One direction from the initial horizon to the eye: a mask of 32 intervals, equal in the sine; each is blocked once.
struct Arc {
    float start, scale;
    uint covered;
    vec3 previous;        // the previous sample's front, from the pixel
    float previousSine;
#ifdef BENT
    vec2 normal, bent;    // the normal along v and the direction; sum over blocked intervals of w (n.w), along the same
#endif
};
float placeInArc(Arc arc, float sine) { return clamp((sine - arc.start) * arc.scale, 0.0, 32.0); }
// Number of intervals that a layer newly covers, times its falloff. It covers from its front to its back, or down to `down`, the previous
// sample of its plane. d: its front, from the pixel; ray: the view ray per metre of depth; size: its packed length.
float coverLayer(inout Arc arc, FalloffBlock rho, vec3 d, vec3 ray, float size, float sine, float down, vec3 v, bool counts) {
    float back = min(backCosine(d, ray, size, v), down);
    uint bits = counts ? bitsBetween(placeInArc(arc, back), placeInArc(arc, sine)) & ~arc.covered : 0u;
    arc.covered |= bits;
#ifdef BENT
    // In the sine the measure of w (n.w) is even: sin a da = d cos a, a from v.
    float middle = clamp(0.5 * (max(back, arc.start) + max(sine, arc.start)), -1.0, 1.0), other = sqrt(max(1.0 - middle * middle, 0.0));
    float weight = float(bitCount(bits)) * falloff(rho, layerDistance(d, ray, size));
    arc.bent += weight * max(arc.normal.x * middle + arc.normal.y * other, 0.0) * vec2(middle, other);
#endif
    return float(bitCount(bits)) * falloff(rho, layerDistance(d, ray, size));
}
#endif

void main() {
    // Copies, so that the loops hold them in registers.
    View view = viewBlock;
    FalloffBlock rho = constants.falloff;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 texel = p + ivec2(view.guard);
    float z = imageLoad(depth, texel).x;
    if (isSky(view, z)) {
        imageStore(visibility, p, vec4(1.0));
#ifdef BENT
        imageStore(bentNormals, p, rawBent(z, vec3(0.0)));
#endif
        return;
    }
    vec2 pixel = vec2(texel) + 0.5;
    vec3 here = eyePosition(view, pixel, z);
    vec3 n = unpackNormal(imageLoad(normals, texel).x);
    vec3 toEye = towardsEye(view, here);
    if (dot(n, toEye) < 0.0) n = -n;
    vec3 v = constants.viewAxis != 0u ? toEye : vec3(0, 0, 1);
    float cosBias = cos(constants.bias), sinBias = sin(constants.bias);
    float leastRise = constants.sampleTest != 0u ? sinBias : -1.0;

    float reach = min(rho.reach * view.pixelsPerMetre / (view.orthographic > 0.5 ? 1.0 : z), constants.maxPixels);
    int tile = (p.y & 3) * 4 + (p.x & 3);
    vec3 shift = frameShift(view);
    vec2 noise = constants.side > 1u ? pixelNoise(p).xy : (vec2(kRotation[tile], kOffset[tile]) + 0.5) / 16.0;
    float rotation = fract(noise.x + shift.x);
    float offset = fract(noise.y + shift.y);
    float stepPixels = max(reach / float(constants.steps), 1.0);
    float reachPixels = stepPixels * float(constants.steps);
    float inverseSteps = 1.0 / float(constants.steps);
    ivec2 last = ivec2(view.size) - 1;
    vec2 size = vec2(view.size);

#ifdef BENT
    vec3 bentBlocked = vec3(0.0), bentWhole = vec3(0.0);
#endif
    float blocked = 0.0;
    vec2 shape = pixelShape(view);
    uint shares = constants.side * constants.side;
    for (uint k = constants.side > 1u ? shareOf(view, p, constants.side) : 0u;;) {
        float angle = (float(k) + rotation) * kTwoPi / float(constants.directions);
        vec2 direction = vec2(cos(angle), sin(angle)) * shape;
        float tangent = tangentSine(view, here, n, v, pixel, direction);
        // sin(t + bias)
        float horizon = min(tangent * cosBias + sqrt(max(1.0 - tangent * tangent, 0.0)) * sinBias, 1.0);
#ifdef BENT
        vec3 across = eyePosition(view, pixel + direction, z) - here;
        across = normalize(across - dot(across, v) * v);
        float nv = dot(n, v), no = dot(n, across);
        vec2 bentLow = bentArc(nv, no, -no * inversesqrt(max(nv * nv + no * no, 1e-12))), bent = vec2(0.0);
#endif
#ifdef DEPTH_LAYERS
        Arc arc = Arc(horizon, 32.0 / max(1.0 - horizon, 1e-4), 0u, vec3(0.0), 1.0
#ifdef BENT
            , vec2(nv, no), vec2(0.0)
#endif
        );
        float covered = 0.0;
#endif
        for (uint i = 0u;;) {
            float t = (float(i) + offset) * inverseSteps;
            vec2 at = pixel + direction * max(mix(t, t * t, constants.spacing) * reachPixels, 1.0);
            ivec2 q = clamp(ivec2(at), ivec2(0), last);
            bool inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, size));
#ifdef DEPTH_LAYERS
            LayerSample s = layerSampleAt(view, imageLoad(packedLayers, q), q, here, n, v, arc.previous);
            covered += coverLayer(arc, rho, s.first, s.ray, s.layers.firstLength, s.cosines.x, s.joined ? arc.previousSine : 1.0, v,
                inside && s.heights.x >= leastRise);
            covered += coverLayer(arc, rho, s.second, s.ray, s.layers.secondLength, s.cosines.y, 1.0, v,
                inside && s.layers.second > 0.0 && s.heights.y >= leastRise);
            arc.previous = inside ? s.first : arc.previous;
            arc.previousSine = inside ? s.cosines.x : arc.previousSine;
#else
            vec3 d = eyePosition(view, vec2(q) + 0.5, imageLoad(depth, q).x) - here;
            float distance2 = dot(d, d);
            float inverse = inversesqrt(max(distance2, 1e-20));
            float sine = dot(d, v) * inverse;
            float gain = inside && dot(d, n) * inverse >= leastRise ? max(sine - horizon, 0.0) : 0.0;
            blocked += falloff(rho, distance2 * inverse) * gain;
            horizon += gain;
#ifdef BENT
            bent += falloff(rho, distance2 * inverse) * (bentArc(nv, no, horizon - gain) - bentArc(nv, no, horizon));
#endif
#endif
            if (++i >= constants.steps) break;
        }
#ifdef DEPTH_LAYERS
        blocked += covered / arc.scale;
#endif
#ifdef BENT
#ifdef DEPTH_LAYERS
        bent = 2.0 * arc.bent / arc.scale;
#endif
        bentBlocked += bent.x * v + bent.y * across;
        bentWhole += bentLow.x * v + bentLow.y * across;
#endif
        if ((k += shares) >= constants.directions) break;
    }
#ifdef BENT
    float each = 1.0 / float(constants.directions / shares);
    imageStore(bentNormals, p, rawBent(z, blockedBent(each * bentBlocked, each * bentWhole, n, clamp(1.0 - each * blocked, 0.0, 1.0))));
#endif
    imageStore(visibility, p, vec4(clamp(1.0 - blocked / float(constants.directions / shares), 0.0, 1.0)));
}
