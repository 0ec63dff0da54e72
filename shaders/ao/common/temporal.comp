// Temporal reprojection of visibility. History is read at the motion vector or, with CAMERA, where last frame's camera saw the surface if
// it is at rest [Hoang 2012, eq. 12], bilinearly from those of its four pixels that are in the plane of this pixel's surface, as that
// camera saw it, and have a similar normal. Last frame's picture may have another size and projection. History is clamped to the spread of
// the current frame around the pixel, so that moved occluders leave no trail; clamping also reduces the number of accumulated frames.
// Spatial spread misses two kinds of noise: errors that are smooth in space and change as a surface moves over the image, and noise of
// surfaces one pixel wide. So each pixel also keeps its mean change from frame to frame (unrest), which widens the clamp. For a pixel
// without motion only changes that reverse direction count, because a steady change is a moving shadow. Visibility is kept in 14 bits: in 8
// bits or a half, slow averages stop 1/255 short of their target.
#version 460
#pragma variant CAMERA
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, r16f) uniform readonly image2D current;
layout(set = 0, binding = 4, rg32ui) uniform readonly uimage2D history;
layout(set = 0, binding = 5, r16f) uniform writeonly image2D result;
layout(set = 0, binding = 6, rg32ui) uniform writeonly uimage2D newHistory;
#ifndef CAMERA
layout(set = 0, binding = 7) uniform sampler2D motion;
#endif
layout(push_constant) uniform Block { Reproject constants; };

const float kLongest = 63.0;  // maximum of accumulated frames
const float kUnrest = 1.5;    // factor on the mean change; 1.25 is one standard deviation of noise
const float kUnrestFrames = 8.0;
const float kUnrestUnit = 1.0 / 16384.0;  // of visibility; maximum 1/8

// Depth in 20 bits: the highest of a float. Orthographic depths may be large beside what they differ by, so there only their remainder by a
// period is kept, in even steps. Sky is then any depth, but has no accumulated frames.
layout(constant_id = 0) const bool kOrthographic = false;
float periodOf(float orthographicDepth) { return 256.0 * orthographicDepth; }
uint depthBits(View view, float z) {
    return kOrthographic ? uint(fract(z / periodOf(view.orthographicDepth)) * 1048575.0) << 12 : floatBitsToUint(z) & 0xfffff000u;
}
// The depth of these bits of last frame; orthographic: the one nearest to `expected`.
float previousDepthOf(uint bits, float expected) {
    if (!kOrthographic) return uintBitsToFloat(bits & 0xfffff000u);
    float period = periodOf(constants.previousOrthographicDepth), off = float(bits >> 12) / 1048575.0 - expected / period;
    return expected + (off - round(off)) * period;
}
// In last frame's eye space.
vec3 previousPosition(vec2 texel, float z) {
    vec2 xy = texel * constants.previousUnproject.xy + constants.previousUnproject.zw;
    return vec3(xy * (kOrthographic ? 1.0 : z), -z);
}
// The other bits: 11 of unrest, then 1 if the last change was a rise.
uint packDepth(View view, float z, float unrest, bool rose) {
    return depthBits(view, z) | (rose ? 0x800u : 0u) | uint(min(unrest / kUnrestUnit + 0.5, 2047.0));
}

// 14 bits of visibility, 6 of accumulated frames, 6 and 6 of the octahedral normal (error up to 3 degrees).
uint packHistory(float value, float frames, uint normal) {
    uvec2 e = uvec2((unpackSnorm2x16(normal) * 0.5 + 0.5) * 63.0 + 0.5);
    return uint(value * 16383.0 + 0.5) | uint(frames + 0.5) << 14 | e.x << 20 | e.y << 26;
}

void main() {
    // Copies, so that the loops hold them in registers.
    View view = viewBlock;
    float farthest = constants.depthTolerance, leastCosine = constants.normalTolerance;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), guard = ivec2(view.guard), last = ivec2(view.visible) - 1;
    if (any(greaterThan(p, last))) return;
    float z = imageLoad(depth, p + guard).x, visibility = imageLoad(current, p).x;
    uint packedNormal = imageLoad(normals, p + guard).x;
    if (isSky(view, z)) {
        imageStore(result, p, vec4(visibility));
        imageStore(newHistory, p, uvec4(packDepth(view, z, 0.0, false), packHistory(visibility, 0.0, packedNormal), 0, 0));
        return;
    }

    // Position and normal in last frame's eye space if the surface did not move in the world.
    vec3 here = eyePosition(view, vec2(p + guard) + 0.5, z), n = unpackNormal(packedNormal);
    vec4 r0 = constants.previousFromEye[0], r1 = constants.previousFromEye[1], r2 = constants.previousFromEye[2];
    vec3 previous = vec3(dot(r0.xyz, here) + r0.w, dot(r1.xyz, here) + r1.w, dot(r2.xyz, here) + r2.w);
    vec3 previousNormal = vec3(dot(r0.xyz, n), dot(r1.xyz, n), dot(r2.xyz, n));
    float previousDepth = -previous.z;
    vec4 texel = constants.previousTexel;
#ifdef CAMERA
    vec2 at = previous.xy / (kOrthographic ? 1.0 : previousDepth) * texel.xy + texel.zw;
    float plane = dot(previous, previousNormal);
#else
    vec2 at = vec2(p) * texel.xy + texel.zw + texelFetch(motion, p + guard, 0).xy * constants.motionScale;
    // A moving receiver was elsewhere: the plane goes through its pixel of last frame instead.
    float plane = dot(previousPosition(at, previousDepth), previousNormal);
#endif
    farthest *= kOrthographic ? view.orthographicDepth : previousDepth;
    ivec2 previousLast = ivec2(constants.previousVisible) - 1;

    vec2 corner = floor(at), fraction = at - corner;
    float sum = 0.0, frameSum = 0.0, unrest = 0.0, riseSum = 0.0, weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1), q = ivec2(corner) + step;
        bool inside = all(greaterThanEqual(q, ivec2(0))) && all(lessThanEqual(q, previousLast));
        ivec2 c = clamp(q, ivec2(0), previousLast);
        uvec2 stored = imageLoad(history, c).xy;
        float zq = previousDepthOf(stored.x, previousDepth);
        float off = abs(dot(previousPosition(vec2(c), zq), previousNormal) - plane);
        vec3 m = fromOctahedron(vec2(stored.yy >> uvec2(20, 26) & 63u) * (2.0 / 63.0) - 1.0);
        bool same = inside && off <= farthest && dot(m, previousNormal) >= leastCosine;
        vec2 w2 = mix(1.0 - fraction, fraction, vec2(step));
        float w = same ? w2.x * w2.y : 0.0;
        sum += w * float(stored.y & 16383u);
        frameSum += w * float(stored.y >> 14 & 63u);
        unrest += w * float(stored.x & 0x7ffu);
        riseSum += w * float(stored.x >> 11 & 1u);
        weights += w;
    }
    bool hasHistory = constants.valid != 0u && weights > 0.01;
    float old = hasHistory ? sum / (weights * 16383.0) : visibility, frames = hasHistory ? frameSum / weights : 0.0;
    unrest = hasHistory ? unrest / weights * kUnrestUnit : 0.0;
    float motionWeight = clamp(2.0 * length(at - vec2(p)), 0.0, 1.0);  // 1 from half a pixel per frame on

    // Noise: variance of 3x3 pixels, 2 px apart, around a linear fit. Adjacent pixels are correlated by the blur, and a slope is the edge
    // of a shadow, not noise.
    float mean = 0.0, square = 0.0;
    vec2 slope = vec2(0.0);
    for (int y = -2; y <= 2; y += 2)
        for (int x = -2; x <= 2; x += 2) {
            float v = imageLoad(current, clamp(p + ivec2(x, y), ivec2(0), last)).x;
            mean += v;
            square += v * v;
            slope += v * vec2(x, y);
        }
    mean /= 9.0;
    slope /= 12.0;  // per step of 2 px
    float noise = max(square / 9.0 - mean * mean - dot(slope, slope) * (2.0 / 3.0), 0.0);  // variance
    float spread = constants.clip * sqrt(noise + kUnrest * kUnrest * unrest * unrest) + constants.clipFloor;
    float clamped = constants.clip > 0.0 ? clamp(old, mean - spread, mean + spread) : old;
    frames *= clamp(1.0 - abs(clamped - old) / max(spread, 1e-6), 0.0, 1.0);

    frames = min(frames + 1.0, kLongest);
    float value = mix(visibility, clamped, hasHistory ? min(1.0 - 1.0 / frames, constants.history) : 0.0);
    imageStore(result, p, vec4(value));
    bool rose = visibility > old, turned = rose != (riseSum > 0.5 * weights);
    float change = mix(turned ? 2.0 * abs(visibility - old) : 0.0, abs(visibility - old), motionWeight);
    unrest += hasHistory ? (change - unrest) / min(frames, kUnrestFrames) : 0.0;
    imageStore(newHistory, p, uvec4(packDepth(view, z, unrest, rose), packHistory(value, frames, packedNormal), 0, 0));
}
