// Octahedral normals of the host -> packed eye-space normals, rotated if they are in world space.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#include "shared/octahedral.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform usampler2D source;
layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D normals;
layout(push_constant) uniform Block { ConvertNormals constants; };

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, constants.size))) return;
    vec3 n = unpackNormal(texelFetch(source, p, 0).x);
    n = normalize(vec3(dot(constants.rows[0].xyz, n), dot(constants.rows[1].xyz, n), dot(constants.rows[2].xyz, n)));
    imageStore(normals, p, uvec4(packNormal(n)));
}
