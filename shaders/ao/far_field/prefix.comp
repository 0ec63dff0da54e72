// Prefix sums over lines, in place: one invocation an interval index [Timonen 2013, sec. 7]. Cells hold (m0, m1, 1), or zeros where there is
// nothing, so any run of lines has its mean and its count by one subtraction.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/far_field/grid.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Directions { Direction directionsOf[]; };
layout(set = 0, binding = 1, std430) buffer Cells { float cells[]; };
layout(push_constant) uniform Constants { FarFieldConstants constants; };

void main() {
    Direction d = directionsOf[gl_GlobalInvocationID.z];
    uint level = gl_GlobalInvocationID.y, intervals = d.intervals >> level, j = gl_GlobalInvocationID.x;
    if (j >= intervals) return;
    uint at = (levelBase(d, level, kPrefix) + j) * 3u;
    vec3 sum = vec3(0.0);
    for (uint line = 0u; line < d.lines; ++line) {
        sum += vec3(cells[at], cells[at + 1u], cells[at + 2u]);
        cells[at] = sum.x;
        cells[at + 1u] = sum.y;
        cells[at + 2u] = sum.z;
        at += intervals * 3u;
    }
}
