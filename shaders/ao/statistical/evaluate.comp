// Visibility from adaptive layers: mean height of each layer in each cell of the pixel's window [Hendrickx, eq. 5, alg. 2]. Of each pair of
// layers one has a table; the other is its parent's table minus that.
// In: depth, normals, extent, tables (unused ones are bound to the root). Out: visibility, R16F.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#include "ao/statistical/constants.h"
#include "ao/statistical/window.glsl"
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
    if (isOpen(view, box, originOf(view, extent), eyePosition(view, vec2(texel) + 0.5, z), z)) {
        imageStore(visibility, p, vec4(1.0));
        return;
    }
    vec2 pixel = vec2(texel) + 0.5, centre = pixel / float(box.texelSide);
    Shape shape = shapeOf(view, box, extent, pixel, z, imageLoad(normals, texel).x, constants.slope, constants.viewAligned != 0u);
    vec2 reach = halfWindow(view, box, z) / float(box.texelSide) * vec2(box.columns, 1.0);
    float blocked = 0.0, cells = 0.0;  // blocked fractions added up over cells that are not empty, and their number
    [[dont_unroll]] for (uint column = 0u; column < split; ++column) {
        Column c = columnAt(centre, reach, constants.size, column);
        vec2 cell = cellsOf(c);
        cells += cell.x + cell.y;
        vec2 perPixel = cell / pixelsOf(box, c);
        Sums whole = sumRoot(0u, c, constants.size, shape.up);
        if (layers == 1u) {
            blocked += dot(blockedBy(whole, shape), perPixel);
        } else {
            Sums near = sumFirst(0u, c, constants.size, shape.up), far = minus(whole, near);
            if (layers == 2u) {
                blocked += dot(blockedBy(near, shape) + blockedBy(far, shape), perPixel);
            } else {
                [[dont_unroll]] for (uint i = 0u; i < 2u; ++i) {
                    Sums nearer = sumSecond(i, c, constants.size, shape.up), farther = minus(near, nearer);
                    if (layers == 4u) {
                        blocked += dot(blockedBy(nearer, shape) + blockedBy(farther, shape), perPixel);
                    } else {
                        Sums part = sumThird(2u * i, c, constants.size, shape.up);
                        blocked += dot(blockedBy(part, shape) + blockedBy(minus(nearer, part), shape), perPixel);
                        part = sumThird(2u * i + 1u, c, constants.size, shape.up);
                        blocked += dot(blockedBy(part, shape) + blockedBy(minus(farther, part), shape), perPixel);
                    }
                    near = far;
                }
            }
        }
    }
    imageStore(visibility, p, vec4(clamp(1.0 - constants.gain * blocked / max(cells, 1.0), 0.0, 1.0)));
}
