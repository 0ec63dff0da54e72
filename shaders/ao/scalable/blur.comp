// Blur along one axis over nine pixels with a stride of 2 px, weighted by depth [McGuire 2012, sec. 2.4].
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/scalable/constants.h"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r16f) uniform readonly image2D source;
layout(set = 0, binding = 3, r16f) uniform writeonly image2D result;
layout(push_constant) uniform Block { ScalableBlur constants; };

const float kGauss[5] = float[](0.153170, 0.144893, 0.122649, 0.092902, 0.062970);
const float kBase = 0.3;                  // added to the weight of all pixels but the centre
const float kSharpness = 2000.0 / 150.0;  // per radius of depth difference; published for a far plane at 300 m and a radius of 2 m

void main() {
    View view = viewBlock;  // a copy, so that the loop holds it in registers
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = ivec2(view.visible) - 1, guard = ivec2(view.guard);
    if (any(greaterThan(p, last))) return;
    ivec2 axis = constants.vertical != 0u ? ivec2(0, 2) : ivec2(2, 0);
    float sharpness = kSharpness / constants.radius, z = imageLoad(depth, p + guard).x, sum = kGauss[0] * imageLoad(source, p).x,
          weights = kGauss[0];
    for (int r = -4; r <= 4; ++r) {
        ivec2 q = clamp(p + r * axis, ivec2(0), last);
        float w = (kBase + kGauss[abs(r)]) * max(0.0, 1.0 - sharpness * abs(imageLoad(depth, q + guard).x - z));
        w = r == 0 ? 0.0 : w;
        sum += w * imageLoad(source, q).x;
        weights += w;
    }
    imageStore(result, p, vec4(isSky(view, z) ? 1.0 : sum / weights));
}
