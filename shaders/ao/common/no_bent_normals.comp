// One raw bent normal of a picture in which nothing is blocked.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/bent_normals.glsl"
layout(local_size_x = 1, local_size_y = 1) in;
layout(set = 0, binding = 0, rg32ui) uniform writeonly uimage2D bentNormals;

void main() { imageStore(bentNormals, ivec2(0), rawBent(1.0, vec3(0.0))); }
