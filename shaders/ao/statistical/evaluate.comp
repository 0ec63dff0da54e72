// Visibility from adaptive layers: mean height of each layer in each cell of the pixel's window [Hendrickx, eq. 5, alg. 2]. Of each pair of
// layers one has a table; the other is its parent's table minus that.
// In: depth, normals, extent, tables (unused ones are bound to the root). Out: visibility, R16F.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/statistical/constants.h"
#include "ao/statistical/fixed_point.h"
#include "ao/statistical/window.glsl"
#include "shared/octahedral.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, std430) readonly buffer ExtentBlock { Extent extent; };
layout(set = 0, binding = 4, std430) readonly buffer Root { uvec4 root[]; };
layout(set = 0, binding = 5, std430) readonly buffer First { uvec4 first[]; };      // near
layout(set = 0, binding = 6, std430) readonly buffer Second { uvec4 second[]; };    // nearer of the near, nearer of the far
layout(set = 0, binding = 7, std430) readonly buffer Third { uvec4 third[]; };      // nearest of each of those four
layout(set = 0, binding = 8, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Block { StatisticalEvaluate constants; };
layout(constant_id = 1) const uint layers = 4;  // 1, 2, 4, 8

WINDOW_SUMS(sumRoot, root, 1u)
WINDOW_SUMS(sumFirst, first, 1u)
WINDOW_SUMS(sumSecond, second, 2u)
WINDOW_SUMS(sumThird, third, 4u)

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
    Shape shape;
    shape.here = eyePosition(view, pixel, z);
    shape.n = unpackNormal(imageLoad(normals, texel).x);
    if (dot(shape.n, towardsEye(view, shape.here)) < 0.0) shape.n = -shape.n;
    shape.metres = 1.0 / unitsPerMetre(view, box, extent);
    shape.height = boxHeight(view, box, z);
    shape.slope = constants.slope;

    vec2 centre = pixel / float(box.texelSide);
    float reach = halfWindow(view, box, z) / float(box.texelSide);
    Axis x = axisOf(centre.x, reach, constants.size.x), y = axisOf(centre.y, reach, constants.size.y);
    uint pitch = constants.size.x + 1u;
    // Level by level: each parent becomes its farther half by subtracting its nearer one.
    mat4 furthest = sumRoot(0u, x, y, pitch), near, middle, far;  // sums of up to four layers
    vec4 count = counts(furthest), blocked = vec4(0.0);
    if (layers >= 2u) {
        near = sumFirst(0u, x, y, pitch);
        furthest -= near;
    }
    if (layers >= 4u) {
        middle = near;
        near = sumSecond(0u, x, y, pitch);
        middle -= near;
        far = sumSecond(1u, x, y, pitch);
        furthest -= far;
    }
    if (layers >= 8u) {
        mat4 half0 = sumThird(0u, x, y, pitch), half1 = sumThird(1u, x, y, pitch), half2 = sumThird(2u, x, y, pitch),
             half3 = sumThird(3u, x, y, pitch);
        blocked = blockedBy(half0, shape) + blockedBy(half1, shape) + blockedBy(half2, shape) + blockedBy(half3, shape);
        near -= half0;
        middle -= half1;
        far -= half2;
        furthest -= half3;
    }
    blocked += blockedBy(furthest, shape);
    if (layers >= 2u) blocked += blockedBy(near, shape);
    if (layers >= 4u) blocked += blockedBy(middle, shape) + blockedBy(far, shape);
    imageStore(visibility, p, vec4(clamp(1.0 - constants.gain * meanOfCells(blocked, count, x, y), 0.0, 1.0)));
}
