// Samples on a spiral around each pixel; distant ones read coarser depths. See runtime/ao/methods/scalable/scalable.cpp.
// In: packed normals, depth and its coarser levels, guard band included. Out: visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/depth_mips.glsl"
#include "ao/common/pixel_shape.glsl"
#include "ao/scalable/constants.h"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 2, r32f) uniform readonly image2D depths;
layout(set = 0, binding = 3, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Block { ScalableSpiral constants; };
layout(constant_id = 0) const bool kQuads = true;

// Lengths are published in metres; here they are in radii, converted for a radius of 2 m.
const float kEpsilon = 0.0025;     // squared radii
const float kSameDepth = 0.01;     // radii; largest depth difference of neighbours that are averaged
const float kFinest = 3.0;         // log2 of px up to which level 0 is read

shared vec2 quads[8][8];  // visibility and depth, of quads of 2x2

float visibilityAt(View view, ivec2 texel, float z) {
    float r2 = constants.radius * constants.radius, off = constants.bias;
    ivec2 last = ivec2(view.size) - 1, padded = paddedSize(view.size);
    vec3 here = eyePosition(view, vec2(texel) + 0.5, z), n = unpackNormal(imageLoad(normals, texel).x);
    n = dot(n, towardsEye(view, here)) < 0.0 ? -n : n;
    float reach = constants.radius * view.pixelsPerMetre / (view.orthographic > 0.5 ? 1.0 : z);
    ivec2 p = texel - ivec2(view.guard);
    float spin = float((3 * p.x ^ p.y + p.x * p.y) * 10 & 0xffff) + 6.28318531 * frameShift(view).x;  // radians, wrapped: a hash
    vec2 shape = pixelShape(view);
    float sum = 0.0, part = 1.0 / float(constants.samples);
    for (uint i = 0u;;) {
        float alpha = (float(i) + 0.5) * part, angle = alpha * float(constants.turns) * 6.28318531 + spin, l = alpha * reach;
        int level = clamp(int(floor(log2(l) - kFinest)), 0, kDepthLevels - 1);
        ivec2 q = clamp(texel + ivec2(l * vec2(cos(angle), sin(angle)) * shape), ivec2(0), last);
        vec3 v = eyePosition(view, vec2(q) + 0.5, imageLoad(depths, mipTexel(padded, q, level)).x) - here;
        float vv = dot(v, v), f = max(r2 - vv, 0.0);
        sum += f * f * f * max((dot(v, n) - off) / (kEpsilon * r2 + vv), 0.0);
        if (++i >= constants.samples) break;
    }
    return max(1.0 - sum * 5.0 * constants.intensity * part / (r2 * r2 * r2), 0.0);
}

void main() {
    View view = viewBlock;  // a copy, so that the loop holds it in registers
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), own = ivec2(gl_LocalInvocationID.xy), last = ivec2(view.visible) - 1;
    ivec2 texel = min(p, last) + ivec2(view.guard);
    float z = imageLoad(depths, texel).x;
    vec2 result = vec2(isSky(view, z) ? 1.0 : visibilityAt(view, texel, z), z);
    for (int axis = 0; axis < 2; ++axis) {  // mean with the neighbour in the 2x2 quad, horizontally, then vertically
        quads[own.y][own.x] = result;
        barrier();
        vec2 other = quads[own.y ^ axis][own.x ^ (1 - axis)];
        result.x = kQuads && abs(other.y - result.y) < kSameDepth * constants.radius ? 0.5 * (result.x + other.x) : result.x;
        barrier();
    }
    if (all(lessThanEqual(p, last))) imageStore(visibility, p, vec4(min(result.x, 1.0)));
}
