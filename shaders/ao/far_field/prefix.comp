// Prefix sums over lines, in place, one invocation per interval index [Timonen 2013, sec. 7]. Cells are (m0, m1, 1), or zeros if empty, so
// one subtraction gives mean and count of any range of lines.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/far_field/grid.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Directions { Direction directionsOf[]; };
#define SUMS
#define CELLS_BINDING 1
#define CELLS_ACCESS
#include "ao/far_field/cells.glsl"
layout(push_constant) uniform Block { FarFieldConstants constants; };

void main() {
    Direction d = directionsOf[gl_GlobalInvocationID.z];
    uint level = gl_GlobalInvocationID.y, intervals = d.intervals >> level, j = gl_GlobalInvocationID.x;
    if (j >= intervals) return;
    uint at = levelBase(d, level, kPrefix) + j * d.lines;
    vec4 sum = vec4(0.0);
    for (uint line = 0u; line < d.lines; ++line) {
        ivec2 cell = texelOf(at + line);
        sum += imageLoad(cells, cell);
        imageStore(cells, cell, sum);
    }
}
