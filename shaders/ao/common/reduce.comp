// Linear depth and normals of every scale-th pixel, each way (runtime/ao/reduction.h). In: both of the frame. Out: both, reduced.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 1, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D reducedDepth;
layout(set = 0, binding = 3, r32ui) uniform writeonly uimage2D reducedNormals;
layout(push_constant) uniform Block { Reduce constants; };

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, constants.size))) return;
    ivec2 q = constants.first + p * constants.scale;
    imageStore(reducedDepth, p, imageLoad(depth, q));
    imageStore(reducedNormals, p, imageLoad(normals, q));
}
