// Extent of each block of the frame, edge pixels repeated to fill the tables' last texels: nearest and furthest depth, largest x or y, sum
// of the largest coordinates. In: linear depth. Out: one Extent per block; orthographic, its sum is of depths beyond its nearest.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/statistical/constants.h"
#include "ao/statistical/fixed_point.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, std430) writeonly buffer Extents { Extent extents[]; };
layout(push_constant) uniform Block { StatisticalExtentBlocks constants; };

const int kColumns = 16, kRows = 4;  // pixels of an invocation, 8 apart
shared uint nearestInverted, furthest, coordinate;
shared float sums[64];

void main() {
    View view = viewBlock;
    Box box = constants.box;
    uint own = gl_LocalInvocationIndex;
    if (own == 0u) nearestInverted = furthest = coordinate = 0u;
    barrier();
    ivec2 first = ivec2(gl_WorkGroupID.xy) * ivec2(8 * kColumns, 8 * kRows) + ivec2(gl_LocalInvocationID.xy);
    ivec2 last = ivec2(view.size) - 1, side = ivec2(box.texelSide), end = (ivec2(view.size) + side - 1) / side * side;
    bool orthographic = view.orthographic > 0.5;
    float limit = orthographic ? 3.0e38 : box.limit;
    float near = 3.0e38, far = 0.0, most = 0.0, sum = 0.0, count = 0.0;
    for (int y = 0; y < kRows; ++y) {
        for (int x = 0; x < kColumns; ++x) {
            ivec2 at = first + 8 * ivec2(x, y), p = min(at, last);
            float z = imageLoad(depth, p).x;
            vec3 here = abs(eyePosition(view, vec2(p) + 0.5, z));
            float across = max(here.x, here.y), largest = max(z, across);
            bool open = any(greaterThanEqual(at, end)) || isSky(view, z) || largest > limit;
            near = open ? near : min(near, z);
            far = open ? far : max(far, z);
            most = open ? most : max(most, across);
            sum += open ? 0.0 : orthographic ? z + across : largest;
            count += open ? 0.0 : 1.0;
        }
    }
    if (far > 0.0) {
        atomicMax(nearestInverted, ~floatBitsToUint(near));
        atomicMax(furthest, floatBitsToUint(far));
        atomicMax(coordinate, floatBitsToUint(most));
    }
    barrier();
    sums[own] = sum - (orthographic && count > 0.0 ? count * uintBitsToFloat(~nearestInverted) : 0.0);
    for (uint other = 32u; other > 0u; other >>= 1) {
        barrier();
        if (own < other) sums[own] += sums[own + other];
    }
    if (own == 0u)
        extents[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] =
            Extent(nearestInverted, furthest, coordinate, floatBitsToUint(sums[0]));
}
