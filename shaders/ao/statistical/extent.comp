// Extent of the whole frame from the extents of its blocks; one workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/statistical/constants.h"
#include "ao/statistical/fixed_point.h"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, std430) readonly buffer Blocks { Extent blocks[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Whole { Extent whole; };
layout(push_constant) uniform Block { StatisticalExtent constants; };

const float kBlockPixels = 4096.0;
shared uint nearestInverted, furthest, coordinate;
shared float sums[64];

void main() {
    uint own = gl_LocalInvocationIndex;
    if (own == 0u) nearestInverted = furthest = coordinate = 0u;
    barrier();
    Extent most = Extent(0u, 0u, 0u, 0u);
    for (uint i = own; i < constants.count; i += 64u) {
        most.nearestInverted = max(most.nearestInverted, blocks[i].nearestInverted);
        most.furthest = max(most.furthest, blocks[i].furthest);
        most.coordinate = max(most.coordinate, blocks[i].coordinate);
    }
    atomicMax(nearestInverted, most.nearestInverted);
    atomicMax(furthest, most.furthest);
    atomicMax(coordinate, most.coordinate);
    barrier();
    bool orthographic = viewBlock.orthographic > 0.5;
    float sum = 0.0, nearest = uintBitsToFloat(~nearestInverted);
    for (uint i = own; i < constants.count; i += 64u) {
        float beyond = blocks[i].furthest > 0u && orthographic ? kBlockPixels * (nearestDepth(blocks[i]) - nearest) : 0.0;
        sum += uintBitsToFloat(blocks[i].sum) + beyond;
    }
    sums[own] = sum;
    for (uint other = 32u; other > 0u; other >>= 1) {
        barrier();
        if (own < other) sums[own] += sums[own + other];
    }
    if (own == 0u) whole = Extent(nearestInverted, furthest, coordinate, floatBitsToUint(sums[0]));
}
