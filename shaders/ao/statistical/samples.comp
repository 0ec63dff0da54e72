// Volumetric obscurance of the same box by samples [Loos 2010], for comparison. Points: blocked or not, each at its own height. Lines: the
// blocked fraction of a line along the normal. Positions fill the window evenly.
// In: linear depth, packed normals. Out: visibility, R16F.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/tile.glsl"
#include "ao/statistical/constants.h"
#include "ao/statistical/fixed_point.h"
#include "ao/statistical/window.glsl"
#include "shared/octahedral.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Block { StatisticalSamples constants; };

const vec2 kNext = vec2(0.7548776662, 0.5698402910);  // successive multiples fill the square evenly

void main() {
    View view = viewBlock;
    Box box = constants.box;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 texel = p + ivec2(view.guard);
    float z = imageLoad(depth, texel).x;
    if (isSky(view, z)) {
        imageStore(visibility, p, vec4(1.0));
        return;
    }
    vec2 pixel = vec2(texel) + 0.5;
    vec3 here = eyePosition(view, pixel, z);
    vec3 n = constants.viewAligned != 0u ? vec3(0, 0, 1) : unpackNormal(imageLoad(normals, texel).x);
    n = dot(n, towardsEye(view, here)) < 0.0 ? -n : n;
    vec2 reach = halfWindow(view, box, z) * vec2(box.columns, 1.0);
    float height = boxHeight(view, box, z), blocked = 0.0, count = 0.0;
    // Lines are few, so they are shifted from pixel to pixel over a 4x4 tile and blurred; points are many and are not.
    float shift = constants.lines != 0u ? float(bayer16(uvec2(p))) * float(constants.samples) : 0.0;
    for (uint i = 0u; i < constants.samples; ++i) {
        vec2 at = pixel + (2.0 * fract(0.5 + (float(i) + shift) * kNext) - 1.0) * reach;
        ivec2 q = clamp(ivec2(at), ivec2(0), ivec2(view.size) - 1);
        float zq = imageLoad(depth, q).x;
        float part = psi(dot(eyePosition(view, vec2(q) + 0.5, zq) - here, n) / height, constants.slope);
        float point = part > (float(i) + 0.5) / float(constants.samples) ? 1.0 : 0.0;
        bool inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(view.size)));
        blocked += inside && !isSky(view, zq) ? (constants.lines != 0u ? part : point) : 0.0;
        count += inside ? 1.0 : 0.0;
    }
    imageStore(visibility, p, vec4(clamp(1.0 - constants.gain * blocked / max(count, 1.0), 0.0, 1.0)));
}
