// Summed-area tables, first half: prefix sums along rows, from texels to tables. See runtime/ao/summed_area.h.
#version 460
#extension GL_GOOGLE_include_directive : require
const uint kScanLines = 8u, kScanMost = 16u;
layout(local_size_x = 8, local_size_y = 16) in;
layout(set = 0, binding = 0, std430) readonly buffer Texels { uvec4 texels[]; };
layout(set = 0, binding = 1, std430) readonly buffer Codes { uint codes[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Table { uvec4 table[]; };
layout(push_constant) uniform Constants {
    uvec2 size;        // texels
    uint layers;
    uint masked;       // 0: codes are not read, every texel counts in every layer
    uvec4 masks, values;  // a layer sums the texels with (code & mask) == value
};

uint layer() { return gl_GlobalInvocationID.z; }

uvec4 scanLoad(uint line, uint i) {
    uint at = line * size.x + i;
    return masked == 0u || (codes[at] & masks[layer()]) == values[layer()] ? texels[at] : uvec4(0u);
}

// The table has a column and a row of zeros before the texels'.
void scanStore(uint line, uint i, uvec4 sum) {
    table[((line + 1u) * (size.x + 1u) + i + 1u) * layers + layer()] = sum;
}

#include "shared/scan.glsl"

void main() {
    uint line = gl_GlobalInvocationID.x;
    bool inside = line < size.y;
    if (inside && gl_LocalInvocationID.y == 0u) table[(line + 1u) * (size.x + 1u) * layers + layer()] = uvec4(0u);
    scanLines(line, size.x, inside);
}
