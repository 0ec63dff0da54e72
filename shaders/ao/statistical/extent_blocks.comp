// Extent of each block of the frame: nearest and furthest depth, largest coordinate. In: linear depth. Out: one Extent per block.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/statistical/fixed_point.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, std430) writeonly buffer Extents { Extent extents[]; };

const int kColumns = 16, kRows = 4;  // pixels of an invocation, 8 apart
shared uint nearestInverted, furthest, coordinate;

void main() {
    View view = viewBlock;
    if (gl_LocalInvocationIndex == 0u) nearestInverted = furthest = coordinate = 0u;
    barrier();
    ivec2 first = ivec2(gl_WorkGroupID.xy) * ivec2(8 * kColumns, 8 * kRows) + ivec2(gl_LocalInvocationID.xy);
    ivec2 last = ivec2(view.size) - 1;
    float near = 3.0e38, far = 0.0, most = 0.0;
    for (int y = 0; y < kRows; ++y) {
        for (int x = 0; x < kColumns; ++x) {
            ivec2 p = min(first + 8 * ivec2(x, y), last);
            float z = imageLoad(depth, p).x;
            vec3 here = abs(eyePosition(view, vec2(p) + 0.5, z));
            bool sky = isSky(view, z);
            near = sky ? near : min(near, z);
            far = sky ? far : max(far, z);
            most = sky ? most : max(most, max(z, max(here.x, here.y)));
        }
    }
    if (far > 0.0) {
        atomicMax(nearestInverted, ~floatBitsToUint(near));
        atomicMax(furthest, floatBitsToUint(far));
        atomicMax(coordinate, floatBitsToUint(most));
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        extents[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = Extent(nearestInverted, furthest, coordinate, 0u);
}
