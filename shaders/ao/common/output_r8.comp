// Visibility in 8 bits, rounded to nearest, for VisibilityFormat::r8.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r16f) uniform readonly image2D visibility;
layout(set = 0, binding = 1, r8) uniform writeonly image2D result;
layout(push_constant) uniform Block { Whole constants; };

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, constants.size))) return;
    imageStore(result, p, vec4(imageLoad(visibility, p).x));
}
