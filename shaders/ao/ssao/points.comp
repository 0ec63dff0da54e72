// Point samples in the hemisphere above each pixel; points behind the depth buffer are blocked. See runtime/ao/methods/ssao/ssao.cpp.
// In: linear depth, packed normals (guard band included), the kernel. Out: visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/tile.glsl"
#include "ao/ssao/constants.h"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, std430) readonly buffer Kernel { vec4 kernel[]; };  // metres; z along the normal
layout(set = 0, binding = 4, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Block { SsaoPoints constants; };

void main() {
    View view = viewBlock;  // copies, so that the loop holds them in registers
    float range = constants.radius, least = constants.bias;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = ivec2(view.size) - 1;
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 texel = p + ivec2(view.guard);
    float z = imageLoad(depth, texel).x;
    if (isSky(view, z)) {
        imageStore(visibility, p, vec4(1.0));
        return;
    }
    vec3 here = eyePosition(view, vec2(texel) + 0.5, z), n = unpackNormal(imageLoad(normals, texel).x);
    n = dot(n, towardsEye(view, here)) < 0.0 ? -n : n;
    float angle = 6.28318531 * fract((float(bayer16(uvec2(p))) + 0.5) / 16.0 + frameShift(view).x);
    vec3 turned = vec3(cos(angle), sin(angle), 1e-3), t = normalize(turned - n * dot(turned, n)), b = cross(n, t);
    float blocked = 0.0;
    for (uint i = 0u;;) {
        vec3 k = kernel[i].xyz, s = here + t * k.x + b * k.y + n * k.z;
        float pointDepth = max(-s.z, 1e-3),
              zq = imageLoad(depth, clamp(ivec2(floor(pixelOf(view, vec3(s.xy, -pointDepth)))), ivec2(0), last)).x;
        blocked += zq <= pointDepth - least ? smoothstep(0.0, 1.0, range / abs(z - zq)) : 0.0;
        if (++i >= constants.samples) break;
    }
    imageStore(visibility, p, vec4(1.0 - blocked / float(constants.samples)));
}
