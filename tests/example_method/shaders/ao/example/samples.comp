// Mean of rho(d) times the sine above the tangent plane over samples on a spiral. Formula: runtime/ao/methods/example/example.cpp.
// In: linear depth, packed normals, guard band included. Out: visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/tile.glsl"
#include "ao/example/constants.h"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Block { ExampleSamples constants; };

void main() {
    View view = viewBlock;
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
    float reach = constants.falloff.reach * view.pixelsPerMetre / (view.orthographic > 0.5 ? 1.0 : z), blocked = 0.0;
    float turn = 6.28318531 * fract((float(bayer16(uvec2(p))) + 0.5) / 16.0 + frameShift(view).x);
    for (uint i = 0u; i < constants.samples; ++i) {
        float angle = turn + 2.39996323 * float(i), t = (float(i) + 0.5) / float(constants.samples);
        ivec2 q = ivec2(vec2(texel) + 0.5 + max(t * reach, 1.0) * vec2(cos(angle), sin(angle)));
        if (any(lessThan(q, ivec2(0))) || any(greaterThan(q, last))) continue;
        vec3 d = eyePosition(view, vec2(q) + 0.5, imageLoad(depth, q).x) - here;
        float distance = max(length(d), 1e-6);
        blocked += falloff(constants.falloff, distance) * max(dot(d, n) / distance - constants.bias, 0.0);
    }
    imageStore(visibility, p, vec4(clamp(1.0 - 3.0 * blocked / float(constants.samples), 0.0, 1.0)));
}
