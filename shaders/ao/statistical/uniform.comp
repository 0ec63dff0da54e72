// Visibility from uniform layers, two at a time [Hendrickx, sec. 4, eq. 5], for comparison with adaptive ones.
// In: depth, normals, extent, the table of two layers. In and out: accumulated blocked counts of each column's two cells.
// Out, in the last pass: visibility, R16F.
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
layout(set = 0, binding = 4, std430) readonly buffer Pair { uvec4 pair[]; };
layout(set = 0, binding = 5, std430) buffer Blocked { vec2 blocked[]; };
layout(set = 0, binding = 6, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Block { StatisticalUniform constants; };

WINDOW_SUMS(sumPair, pair, 2u)

void main() {
    View view = viewBlock;
    Box box = constants.box;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 texel = p + ivec2(view.guard);
    float z = imageLoad(depth, texel).x;
    vec2 pixel = vec2(texel) + 0.5, centre = pixel / float(box.texelSide);
    Shape shape = shapeOf(view, box, extent, pixel, z, imageLoad(normals, texel).x, constants.slope, constants.viewAligned != 0u);
    vec2 reach = halfWindow(view, box, z) / float(box.texelSide) * vec2(box.columns, 1.0);
    uint at = 2u * (uint(p.y) * view.visible.x + uint(p.x));
    float fraction = 0.0, cells = 0.0;  // blocked fractions added up over cells that are not empty, and their number
    [[dont_unroll]] for (uint column = 0u; column < split; ++column, ++at) {
        Column c = columnAt(centre, reach, constants.size, column);
        vec2 sum = constants.isFirst != 0u ? vec2(0.0) : blocked[at];
        [[dont_unroll]] for (uint i = 0u; i < 2u; ++i) sum += blockedBy(sumPair(i, c, constants.size, shape.up), shape);
        blocked[at] = sum;
        if (constants.isLast == 0u) continue;
        vec2 cell = cellsOf(c);
        cells += cell.x + cell.y;
        fraction += dot(sum / pixelsOf(box, c), cell);
    }
    if (constants.isLast == 0u) return;
    float open = clamp(1.0 - constants.gain * fraction / max(cells, 1.0), 0.0, 1.0);
    imageStore(visibility, p, vec4(isOpen(view, box, originOf(view, extent), eyePosition(view, pixel, z), z) ? 1.0 : open));
}
