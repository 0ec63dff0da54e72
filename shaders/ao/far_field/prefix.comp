// Prefix sums over lines, in place, one invocation per interval index [Timonen 2013, sec. 7]. A cell is (m0, m1, counts, rest): as floats
// the sums of heights; as integers of 16 bits the number of lines with a point and, above, in the image; as halves what the sums lack. One
// subtraction gives mean and counts of any range of lines. A float alone cannot hold the sum of many far lines and a near one.
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
    Direction d = directionsOf[directionOf(constants, gl_GlobalInvocationID.z)];
    uint level = gl_GlobalInvocationID.y, intervals = d.intervals >> level, j = gl_GlobalInvocationID.x;
    if (j >= intervals) return;
    uint at = levelBase(d, level, kPrefix) + j * d.lines;
    vec2 sum = vec2(0.0), rest = vec2(0.0);
    uint counts = 0u;
    for (uint line = 0u; line < d.lines; ++line) {
        ivec2 texel = texelOf(at + line);
        uvec4 cell = imageLoad(cells, texel);
        // Sum and rounding error [Knuth 1969, 4.2.2], then once more, so that the error stays below half a unit of the sum.
        vec2 height = uintBitsToFloat(cell.xy);
        precise vec2 whole = sum + height, part = whole - sum, error = (sum - (whole - part)) + (height - part) + rest;
        precise vec2 next = whole + error;
        precise vec2 left = error - (next - whole);
        sum = next;
        rest = left;
        counts += cell.z;
        imageStore(cells, texel, uvec4(floatBitsToUint(sum), counts, packHalf2x16(rest)));
    }
}
