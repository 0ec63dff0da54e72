// Device or linear depth of any format -> linear depth, R32F, metres. Values that are not finite, behind the camera or at the far plane
// become sky.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View view; };
layout(set = 0, binding = 1) uniform sampler2D source;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D depth;
layout(push_constant) uniform Block { Linearize constants; };

const float kSkyDepth = 1.0e8;

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.size)))) return;
    float d = texelFetch(source, p, 0).x;
    if (constants.linear == 0u) d = (d * view.linearize.x + view.linearize.y) / (d * view.linearize.z + view.linearize.w);
    bool valid = d > 0.0 && d < view.skyDepth;  // false for NaN too
    imageStore(depth, p, vec4(valid ? d : kSkyDepth));
}
