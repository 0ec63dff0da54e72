// 5x5 mean of neighbours with similar visibility; removes the noise where near and far field meet [Timonen 2013, sec. 10]. Sky takes no
// part: it is open, and its neighbours need not be.
// In: visibility, linear depth. Out: visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/far_field/constants.h"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View view; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r16f) uniform readonly image2D source;
layout(set = 0, binding = 3, r16f) uniform writeonly image2D result;
layout(push_constant) uniform Block { FarFieldBlur constants; };

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = ivec2(view.visible) - 1, guard = ivec2(view.guard);
    if (any(greaterThan(p, last))) return;
    float most = constants.threshold, here = imageLoad(source, p).x, sum = 0.0, count = 0.0;
    if (isSky(view, imageLoad(depth, p + guard).x)) {
        imageStore(result, p, vec4(here));
        return;
    }
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            ivec2 q = p + ivec2(x, y);
            bool inside = all(greaterThanEqual(q, ivec2(0))) && all(lessThanEqual(q, last));
            float v = imageLoad(source, inside ? q : p).x;
            bool alike = inside && abs(v - here) <= most && !isSky(view, imageLoad(depth, q + guard).x);
            sum += alike ? v : 0.0;
            count += alike ? 1.0 : 0.0;
        }
    }
    imageStore(result, p, vec4(sum / count));
}
