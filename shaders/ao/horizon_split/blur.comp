// The paper's blur: 5x5 Gaussian, weighted by the inverse of the depth difference to the centre [Dimitrov, sec. 4.1.3]. The difference is
// relative to depth, so that the blur works at any scale.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r16f) uniform readonly image2D source;
layout(set = 0, binding = 3, r16f) uniform writeonly image2D result;

const float kSharpness = 100.0;

void main() {
    View view = viewBlock;  // a copy, so that the loop holds it in registers
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 guard = ivec2(view.guard), last = ivec2(view.visible) - 1;
    float z = imageLoad(depth, p + guard).x;
    if (isSky(view, z)) {
        imageStore(result, p, vec4(1.0));
        return;
    }
    const float kernel[3] = {6.0, 4.0, 1.0};
    float sharpness = kSharpness / depthForTolerance(view, z), sum = 0.0, weights = 0.0;
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            ivec2 at = p + ivec2(x, y), q = clamp(at, ivec2(0), last);
            float w = kernel[abs(x)] * kernel[abs(y)] / (1.0 + sharpness * abs(imageLoad(depth, q + guard).x - z));
            w = at == q ? w : 0.0;
            sum += w * imageLoad(source, q).x;
            weights += w;
        }
    }
    imageStore(result, p, vec4(sum / weights));
}
