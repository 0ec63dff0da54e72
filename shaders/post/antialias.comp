// Temporal anti-aliasing: the projection moves by a fraction of a pixel each frame, and each pixel is the mean of its samples over frames
// [Karis 2014, High Quality Temporal Supersampling]. History is read where the surface was last frame, by a Catmull-Rom filter of five
// bilinear taps [Jimenez 2016, Filmic SMAA], and clipped to the colours around the pixel [Salvi 2016, An Excursion in Temporal
// Supersampling; clipping: Pedersen 2016, Temporal Reprojection Anti-Aliasing in INSIDE]. Motion is that of the nearest surface of 3x3
// pixels, so that edges move with the object in front. Means are taken of colours compressed to [0, 1), else one bright sample would
// outweigh all others of its pixel.
// In: linear radiance, linear depth and motion, guard band included; last frame's result. Out: linear radiance of the visible part; alpha
// packs the depth of that nearest surface and the number of accumulated frames.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "post/antialias.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, rgba16f) uniform readonly image2D lit;
layout(set = 0, binding = 1, r32f) uniform readonly image2D depthMap;
layout(set = 0, binding = 2) uniform sampler2D motionMap;
layout(set = 0, binding = 3) uniform sampler2D history;  // linear filter
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D result;

layout(push_constant) uniform Constants { AntialiasBlock block; };

// At rest, and from a pixel a frame on, where each frame filters history anew, which blurs it:
const vec2 kMostFrames = vec2(31.0, 5.0);  // n, where this frame has the weight 1 / (n + 1)
const vec2 kSpread = vec2(2.5, 0.8);       // standard deviations that history may be off
const float kFarthest = 60000.0;           // metres: depth of sky in alpha
const float kOccluded = 0.9;               // history of a surface this much nearer shows what hid this one

// To YCoCg of compressed colour, and back.
vec3 compressed(vec3 color) {
    color = min(color, vec3(kFarthest)) * block.exposure;
    color /= 1.0 + max(color.r, max(color.g, color.b));
    return vec3(dot(color, vec3(0.25, 0.5, 0.25)), 0.5 * (color.r - color.b), dot(color, vec3(-0.25, 0.5, -0.25)));
}
vec3 expanded(vec3 c) {
    float t = c.x - c.z;
    vec3 color = clamp(vec3(t + c.y, c.x + c.z, t - c.y), 0.0, 0.9999);
    return color / ((1.0 - max(color.r, max(color.g, color.b))) * block.exposure);
}

// A positive half without its four lowest bits, which with the sign hold the number of frames.
float packed(float depth, float frames) {
    uint bits = packHalf2x16(vec2(min(depth, kFarthest), 0.0)), count = uint(frames);
    return unpackHalf2x16((bits & 0x7ff0u) | (count & 15u) | (count >> 4) << 15).x;
}
void unpackEach(vec4 alpha, out float farthest, out float frames) {
    uvec4 bits = uvec4(packHalf2x16(alpha.xy), packHalf2x16(alpha.zw), 0u, 0u);
    bits = uvec4(bits.x & 0xffffu, bits.x >> 16, bits.y & 0xffffu, bits.y >> 16);
    uvec4 counts = (bits & 15u) | (bits >> 15) << 4, depths = bits & 0x7ff0u;
    frames = float(min(min(counts.x, counts.y), min(counts.z, counts.w)));
    farthest = unpackHalf2x16(max(max(depths.x, depths.y), max(depths.z, depths.w))).x;  // positive halves have the order of their bits
}

vec3 historyAt(vec2 at, vec2 size) {
    vec2 centre = floor(at - 0.5) + 0.5, f = at - centre;
    vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f)), w1 = 1.0 + f * f * (1.5 * f - 2.5), w3 = f * f * (0.5 * f - 0.5);
    vec2 middle = 1.0 - w0 - w3;
    vec2 p0 = (centre - 1.0) / size, p1 = (centre + (middle - w1) / middle) / size, p3 = (centre + 2.0) / size;
    vec4 sum = vec4(textureLod(history, p1, 0.0).rgb, 1.0) * middle.x * middle.y;
    sum += vec4(textureLod(history, vec2(p1.x, p0.y), 0.0).rgb, 1.0) * middle.x * w0.y;
    sum += vec4(textureLod(history, vec2(p0.x, p1.y), 0.0).rgb, 1.0) * w0.x * middle.y;
    sum += vec4(textureLod(history, vec2(p3.x, p1.y), 0.0).rgb, 1.0) * w3.x * middle.y;
    sum += vec4(textureLod(history, vec2(p1.x, p3.y), 0.0).rgb, 1.0) * middle.x * w3.y;
    return max(sum.rgb / sum.a, 0.0);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), guard = ivec2(block.guard), last = ivec2(block.visible) - 1;
    if (any(greaterThan(at, last))) return;

    // Mean and variance of 3x3 colours, and the nearest surface.
    vec3 centre = imageLoad(lit, at + guard).rgb, now = compressed(centre), mean = now, square = now * now;
    ivec2 nearest = at;
    float depth = imageLoad(depthMap, at + guard).x;
    for (int i = 0; i < 9; ++i) {
        if (i == 4) continue;
        ivec2 p = clamp(at + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
        vec3 c = compressed(imageLoad(lit, p + guard).rgb);
        mean += c;
        square += c * c;
        float z = imageLoad(depthMap, p + guard).x;
        if (z < depth) {
            depth = z;
            nearest = p;
        }
    }
    mean /= 9.0;

    vec3 pixel = vec3(vec2(nearest + guard) + 0.5, 1.0);
    vec4 rows[3] = block.previousPixel;
    vec3 previous = vec3(dot(rows[0].xyz, pixel), dot(rows[1].xyz, pixel), dot(rows[2].xyz, pixel));
    bool sky = depth >= kFarthest;
    vec2 motion = sky ? previous.xy / previous.z - pixel.xy : texelFetch(motionMap, nearest + guard, 0).xy;
    float expected = sky ? kFarthest : min(depth * previous.z + rows[2].w, kFarthest);

    vec2 size = vec2(block.visible), from = vec2(at) + 0.5 + motion;
    // A history that is not valid is cleared: its depth is 0.
    bool inside = all(greaterThanEqual(from, vec2(0.0))) && all(lessThanEqual(from, size));
    float farthest, frames;
    unpackEach(textureGather(history, from / size, 3), farthest, frames);
    if (!inside || farthest < kOccluded * expected) {
        imageStore(result, at, vec4(centre, packed(depth, 0.0)));
        return;
    }
    vec3 old = compressed(historyAt(from, size));
    float moving = min(length(motion), 1.0);
    vec3 spread = mix(kSpread.x, kSpread.y, moving) * sqrt(max(square / 9.0 - mean * mean, 0.0)) + 1e-4;
    vec3 off = abs(old - mean) / spread;
    old = mean + (old - mean) / max(max(off.x, max(off.y, off.z)), 1.0);
    frames = min(frames + 1.0, mix(kMostFrames.x, kMostFrames.y, moving));
    imageStore(result, at, vec4(expanded(mix(now, old, frames / (frames + 1.0))), packed(depth, frames)));
}
