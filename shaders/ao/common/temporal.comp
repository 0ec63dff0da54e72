// Temporal reprojection of visibility. The past lies where the motion vector leads; of its four pixels those count, bilinearly,
// that lie in the plane of this pixel's surface as last frame's camera saw it and face the same way. The past is drawn into
// the spread of the present around the pixel, which takes the trail of occluders that moved, and how far it had to be drawn
// shortens its memory. What samples differently wherever a surface comes to lie in the picture has errors that are smooth in space and
// change as it goes; a surface of one pixel has noise that no neighbour shows. So a pixel is allowed what it has kept differing by, frame
// after frame, as well (its unrest). Of one that rests only changes to and fro count: what goes on in one direction is a shadow that comes
// or leaves. Visibility is kept in 14 bits: in 8 or in a half, slow averages stand still a 1/255 off.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3) uniform sampler2D motion;
layout(set = 0, binding = 4, r16f) uniform readonly image2D present;
layout(set = 0, binding = 5, rg32ui) uniform readonly uimage2D past;
layout(set = 0, binding = 6, r16f) uniform writeonly image2D result;
layout(set = 0, binding = 7, rg32ui) uniform writeonly uimage2D pastNow;
layout(push_constant) uniform Constants {
    vec4 previousFromEye[3];  // rows
    vec2 motionScale;         // to px
    float history, depthTolerance, normalTolerance, clip, clipFloor;
    uint valid;
} constants;

const float kLongest = 63.0;  // frames that are counted
const float kUnrest = 1.5;    // times the mean change; 1.25 would be one standard deviation of noise
const float kUnrestFrames = 8.0;
const float kUnrestUnit = 1.0 / 16384.0;  // up to an eighth

// 11 bits of unrest in place of a depth's lowest, above them whether the last change was a rise.
uint packDepth(float z, float unrest, bool rose) { return (floatBitsToUint(z) & 0xfffff000u) | (rose ? 0x800u : 0u) | uint(min(unrest / kUnrestUnit + 0.5, 2047.0)); }

// 14 bits of visibility, 6 of frames, 6 and 6 of the normal's octahedral map (3 degrees at worst).
uint packPast(float value, float frames, uint normal) {
    uvec2 e = uvec2((unpackSnorm2x16(normal) * 0.5 + 0.5) * 63.0 + 0.5);
    return uint(value * 16383.0 + 0.5) | uint(frames + 0.5) << 14 | e.x << 20 | e.y << 26;
}

void main() {
    // Copies, so that the loops hold them in registers.
    View view = viewBlock;
    float farthest = constants.depthTolerance, leastCosine = constants.normalTolerance;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), guard = ivec2(view.guard), last = ivec2(view.visible) - 1;
    if (any(greaterThan(p, last))) return;
    float z = imageLoad(depth, p + guard).x, now = imageLoad(present, p).x;
    uint packedNormal = imageLoad(normals, p + guard).x;
    if (isSky(view, z)) {
        imageStore(result, p, vec4(now));
        imageStore(pastNow, p, uvec4(packDepth(z, 0.0, false), packPast(now, 0.0, packedNormal), 0, 0));
        return;
    }

    // Where the surface was for last frame's camera, had it stood still in the world.
    vec3 here = eyePosition(view, vec2(p + guard) + 0.5, z), n = unpackNormal(packedNormal);
    vec4 r0 = constants.previousFromEye[0], r1 = constants.previousFromEye[1], r2 = constants.previousFromEye[2];
    vec3 there = vec3(dot(r0.xyz, here) + r0.w, dot(r1.xyz, here) + r1.w, dot(r2.xyz, here) + r2.w);
    vec3 faced = vec3(dot(r0.xyz, n), dot(r1.xyz, n), dot(r2.xyz, n));
    vec2 at = vec2(p) + texelFetch(motion, p + guard, 0).xy * constants.motionScale;  // in texel centres of the visible part
    // A receiver that moves is not where the camera alone would have it; the plane is laid through where its pixel was.
    float moved = -there.z;
    float plane = dot(eyePosition(view, at + 0.5 + vec2(guard), moved), faced);
    farthest *= moved;

    vec2 corner = floor(at), part = at - corner;
    float sum = 0.0, gathered = 0.0, unrest = 0.0, rises = 0.0, weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1), q = ivec2(corner) + step;
        bool inside = all(greaterThanEqual(q, ivec2(0))) && all(lessThanEqual(q, last));
        ivec2 c = clamp(q, ivec2(0), last);
        uvec2 stored = imageLoad(past, c).xy;
        float zq = uintBitsToFloat(stored.x & 0xfffff000u);
        float off = abs(dot(eyePosition(view, vec2(c + guard) + 0.5, zq), faced) - plane);
        vec3 m = fromOctahedron(vec2(stored.yy >> uvec2(20, 26) & 63u) * (2.0 / 63.0) - 1.0);
        bool same = inside && off <= farthest && dot(m, faced) >= leastCosine;
        vec2 w2 = mix(1.0 - part, part, vec2(step));
        float w = same ? w2.x * w2.y : 0.0;
        sum += w * float(stored.y & 16383u);
        gathered += w * float(stored.y >> 14 & 63u);
        unrest += w * float(stored.x & 0x7ffu);
        rises += w * float(stored.x >> 11 & 1u);
        weights += w;
    }
    bool known = constants.valid != 0u && weights > 0.01;
    float before = known ? sum / (weights * 16383.0) : now, frames = known ? gathered / weights : 0.0;
    unrest = known ? unrest / weights * kUnrestUnit : 0.0;
    float moves = clamp(2.0 * length(at - vec2(p)), 0.0, 1.0);  // fully from half a pixel a frame on

    // Noise is how far every other pixel around lies off a slope: next to each other, blurred ones differ less than from frame to frame,
    // and a slope is the edge of a shadow, which may move.
    float mean = 0.0, square = 0.0;
    vec2 slope = vec2(0.0);
    for (int y = -2; y <= 2; y += 2)
        for (int x = -2; x <= 2; x += 2) {
            float v = imageLoad(present, clamp(p + ivec2(x, y), ivec2(0), last)).x;
            mean += v;
            square += v * v;
            slope += v * vec2(x, y);
        }
    mean /= 9.0;
    slope /= 12.0;  // from one of them to the next
    float noise = max(square / 9.0 - mean * mean - dot(slope, slope) * (2.0 / 3.0), 0.0);  // variance
    float spread = constants.clip * sqrt(noise + kUnrest * kUnrest * unrest * unrest) + constants.clipFloor;
    float drawn = constants.clip > 0.0 ? clamp(before, mean - spread, mean + spread) : before;
    frames *= clamp(1.0 - abs(drawn - before) / max(spread, 1e-6), 0.0, 1.0);

    frames = min(frames + 1.0, kLongest);
    float value = mix(now, drawn, known ? min(1.0 - 1.0 / frames, constants.history) : 0.0);
    imageStore(result, p, vec4(value));
    bool rose = now > before, turned = rose != (rises > 0.5 * weights);
    float change = mix(turned ? 2.0 * abs(now - before) : 0.0, abs(now - before), moves);
    unrest += known ? (change - unrest) / min(frames, kUnrestFrames) : 0.0;
    imageStore(pastNow, p, uvec4(packDepth(z, unrest, rose), packPast(value, frames, packedNormal), 0, 0));
}
