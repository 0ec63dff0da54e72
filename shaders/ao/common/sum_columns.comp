// Summed-area tables, second half: prefix sums down the columns, in place. See runtime/ao/summed_area.h.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
const uint kScanLines = 8u, kScanMost = 16u;
layout(local_size_x = 8, local_size_y = 16) in;
layout(set = 0, binding = 0, std430) buffer Table { uvec4 table[]; };
layout(push_constant) uniform Block { SumColumns constants; };

uvec4 scanLoad(uint line, uint i) { return table[(i + 1u) * constants.columns + line]; }
void scanStore(uint line, uint i, uvec4 sum) { table[(i + 1u) * constants.columns + line] = sum; }

#include "shared/scan.glsl"

void main() {
    uint line = gl_GlobalInvocationID.x;
    bool inside = line < constants.columns;
    if (inside && gl_LocalInvocationID.y == 0u) table[line] = uvec4(0u);
    scanLines(line, constants.rows, inside);
}
