// Summed-area tables, first half: prefix sums along rows, from texels to tables. See runtime/ao/summed_area.h.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
const uint kScanLines = 8u, kScanMost = 16u;
layout(local_size_x = 8, local_size_y = 16) in;
layout(set = 0, binding = 0, std430) readonly buffer Texels { uvec4 texels[]; };
layout(set = 0, binding = 1, std430) readonly buffer Codes { uint codes[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Table { uvec4 table[]; };
layout(push_constant) uniform Block { SumRows constants; };

uint layer() { return gl_GlobalInvocationID.z; }

uvec4 scanLoad(uint line, uint i) {
    uint at = line * constants.size.x + i;
    return constants.masked == 0u || (codes[at] & constants.masks[layer()]) == constants.values[layer()] ? texels[at] : uvec4(0u);
}

// The table has a column and a row of zeros before the texels'.
void scanStore(uint line, uint i, uvec4 sum) {
    table[((line + 1u) * (constants.size.x + 1u) + i + 1u) * constants.layers + layer()] = sum;
}

#include "shared/scan.glsl"

void main() {
    uint line = gl_GlobalInvocationID.x;
    bool inside = line < constants.size.y;
    if (inside && gl_LocalInvocationID.y == 0u) table[(line + 1u) * (constants.size.x + 1u) * constants.layers + layer()] = uvec4(0u);
    scanLines(line, constants.size.x, inside);
}
