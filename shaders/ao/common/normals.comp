// Normals of any float encoding and space -> packed eye-space normals.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#include "shared/octahedral.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D normals;
layout(push_constant) uniform Block { ConvertNormals constants; };

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, constants.size))) return;
    vec3 n = texelFetch(source, p, 0).xyz;
    if (constants.encoding == 1u) n = n * 2.0 - 1.0;
    n = vec3(dot(constants.rows[0].xyz, n), dot(constants.rows[1].xyz, n), dot(constants.rows[2].xyz, n));
    float length2 = dot(n, n);
    n = length2 > 1e-12 && length2 < 1e12 ? n * inversesqrt(length2) : vec3(0, 0, 1);
    imageStore(normals, p, uvec4(packNormal(n)));
}
