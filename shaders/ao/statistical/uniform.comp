// Visibility from uniform layers, two at a time [Hendrickx, sec. 4, eq. 5], for comparison with adaptive ones.
// In: depth, normals, extent, the root table and that of two layers. In and out: accumulated blocked counts, one component per cell. Out,
// in the last pass: visibility, R16F.
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
layout(set = 0, binding = 5, std430) readonly buffer Pair { uvec4 pair[]; };
layout(set = 0, binding = 6, std430) buffer Blocked { vec4 blocked[]; };
layout(set = 0, binding = 7, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Block { StatisticalUniform constants; };

WINDOW_SUMS(sumRoot, root, 1u)
WINDOW_SUMS(sumPair, pair, 2u)

void main() {
    View view = viewBlock;
    Box box = constants.box;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 texel = p + ivec2(view.guard);
    float z = imageLoad(depth, texel).x;
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
    uint pitch = constants.size.x + 1u, at = uint(p.y) * view.visible.x + uint(p.x);
    vec4 sum = constants.isFirst != 0u ? vec4(0.0) : blocked[at];
    sum += blockedBy(sumPair(0u, x, y, pitch), shape) + blockedBy(sumPair(1u, x, y, pitch), shape);
    blocked[at] = sum;
    if (constants.isLast == 0u) return;
    vec4 count = counts(sumRoot(0u, x, y, pitch));
    imageStore(visibility, p, vec4(isSky(view, z) ? 1.0 : clamp(1.0 - constants.gain * meanOfCells(sum, count, x, y), 0.0, 1.0)));
}
