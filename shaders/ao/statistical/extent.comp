// Extent of the whole frame from the extents of its blocks; one workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/statistical/constants.h"
#include "ao/statistical/fixed_point.h"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Blocks { Extent blocks[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Whole { Extent whole; };
layout(push_constant) uniform Block { StatisticalExtent constants; };

shared uint nearestInverted, furthest, coordinate;

void main() {
    if (gl_LocalInvocationIndex == 0u) nearestInverted = furthest = coordinate = 0u;
    barrier();
    Extent own = Extent(0u, 0u, 0u, 0u);
    for (uint i = gl_LocalInvocationIndex; i < constants.count; i += 64u) {
        own.nearestInverted = max(own.nearestInverted, blocks[i].nearestInverted);
        own.furthest = max(own.furthest, blocks[i].furthest);
        own.coordinate = max(own.coordinate, blocks[i].coordinate);
    }
    atomicMax(nearestInverted, own.nearestInverted);
    atomicMax(furthest, own.furthest);
    atomicMax(coordinate, own.coordinate);
    barrier();
    if (gl_LocalInvocationIndex == 0u) whole = Extent(nearestInverted, furthest, coordinate, 0u);
}
