// Lateral pyramid: a cell of level n is the mean over 2^n lines of the maximum over 2^n intervals, so that a sector is one or two cells
// wide at any distance. One invocation computes three levels from an 8x8 block of cells of level `from`.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/far_field/grid.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, std430) readonly buffer Directions { Direction directionsOf[]; };
#define CELLS_BINDING 2
#define CELLS_ACCESS
#include "ao/far_field/cells.glsl"
layout(push_constant) uniform Block { FarFieldPyramid pyramid; };

void main() {
    View view = viewBlock;  // copies, so that the loop holds them in registers
    FarFieldConstants c = pyramid.constants;
    uint from = pyramid.from;
    Direction d = directionsOf[directionOf(c, gl_GlobalInvocationID.z)];
    uvec2 block = gl_GlobalInvocationID.xy;  // lines, intervals
    uint lines = d.lines >> from, intervals = d.intervals >> from;
    if (block.x * 8u >= lines || block.y * 8u >= intervals) return;
    Axis axis = axisOf(view, d);
    float width = c.interval * float(1u << from), perWidth = ldexp(c.perInterval, -int(from));
    uint above = min(3u, c.levels - 1u - from);
    uint side = 1u << above;  // cells of a block; 8 unless fewer than three levels are left
    block *= 8u;
    for (uint subBlock = 0u; subBlock < 64u >> (2u * above); ++subBlock) {
        uvec2 corner = block + uvec2(subBlock % (8u / side), subBlock / (8u / side)) * side;
        if (corner.x >= lines || corner.y >= intervals) continue;
        vec2 mean1[4], mean2[2], mean3 = vec2(0.0);
        for (uint l = 0u; l < side; ++l) {
            uint line = corner.x + l;
            vec2 best1[4], best2[2], best3 = vec2(kEmptyHeight);
            for (uint i = 0u; i < 4u; ++i) best1[i] = vec2(kEmptyHeight);
            for (uint i = 0u; i < 2u; ++i) best2[i] = vec2(kEmptyHeight);
            for (uint i = 0u; i < side; ++i) {
                uint j = corner.y + i;
                uint cell = imageLoad(cells, texelOf(levelBase(d, from, kPyramid) + j * lines + line)).x;
                best1[i >> 1u] = max(best1[i >> 1u], heightsOf(axis, c, cell, width, startOf(d, width, j)));
            }
            for (uint i = 0u; i < 4u; ++i) best2[i >> 1u] = max(best2[i >> 1u], best1[i]);
            best3 = max(best2[0], best2[1]);
            for (uint i = 0u; i < side / 2u; ++i) {
                vec2 point = pointOf(axis, c, best1[i], middleOf(d, 2.0 * width, (corner.y >> 1u) + i));
                mean1[i] = (l & 1u) == 0u ? point : mean1[i] + point;
                if ((l & 1u) == 1u)
                    imageStore(cells, texelOf(levelBase(d, from + 1u, kPyramid) + ((corner.y >> 1u) + i) * (lines >> 1u) + (line >> 1u)),
                        uvec4(packPoint(mean1[i] * 0.5, 0.5 * perWidth)));
            }
            for (uint i = 0u; i < side / 4u; ++i) {
                vec2 point = pointOf(axis, c, best2[i], middleOf(d, 4.0 * width, (corner.y >> 2u) + i));
                mean2[i] = (l & 3u) == 0u ? point : mean2[i] + point;
                if ((l & 3u) == 3u)
                    imageStore(cells, texelOf(levelBase(d, from + 2u, kPyramid) + ((corner.y >> 2u) + i) * (lines >> 2u) + (line >> 2u)),
                        uvec4(packPoint(mean2[i] * 0.25, 0.25 * perWidth)));
            }
            mean3 += pointOf(axis, c, best3, middleOf(d, 8.0 * width, corner.y >> 3u));
        }
        if (side == 8u)
            imageStore(cells, texelOf(levelBase(d, from + 3u, kPyramid) + (corner.y >> 3u) * (lines >> 3u) + (corner.x >> 3u)),
                uvec4(packPoint(mean3 * 0.125, 0.125 * perWidth)));
    }
}
