// What the whole frame spans, of what its blocks span; by one workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/statistical/fixed_point.h"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Blocks { Extent blocks[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Whole { Extent whole; };
layout(push_constant) uniform Constants { uint count; };

shared uint nearestInverted, furthest, coordinate;

void main() {
    if (gl_LocalInvocationIndex == 0u) nearestInverted = furthest = coordinate = 0u;
    barrier();
    Extent mine = Extent(0u, 0u, 0u, 0u);
    for (uint i = gl_LocalInvocationIndex; i < count; i += 64u) {
        mine.nearestInverted = max(mine.nearestInverted, blocks[i].nearestInverted);
        mine.furthest = max(mine.furthest, blocks[i].furthest);
        mine.coordinate = max(mine.coordinate, blocks[i].coordinate);
    }
    atomicMax(nearestInverted, mine.nearestInverted);
    atomicMax(furthest, mine.furthest);
    atomicMax(coordinate, mine.coordinate);
    barrier();
    if (gl_LocalInvocationIndex == 0u) whole = Extent(nearestInverted, furthest, coordinate, 0u);
}
