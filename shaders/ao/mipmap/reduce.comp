// One level of the depth pyramid: the mean of the texels that a texel covers, or the nearest of them. A texel is (depth times coverage,
// coverage), so that sky takes no part in depths. If the finer size is odd, a texel
// covers parts of three texels on that axis, so that levels stay aligned.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/mipmap/constants.h"
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool kNearest = false;
layout(set = 0, binding = 0, rg32f) uniform readonly image2D finer;
layout(set = 0, binding = 1, rg32f) uniform writeonly image2D coarser;
layout(push_constant) uniform Block { MipmapReduce constants; };

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = constants.coarser, last = constants.finer - 1;
    if (any(greaterThanEqual(p, size))) return;
    vec2 ratio = vec2(last + 1) / vec2(size), from = vec2(p) * ratio, to = from + ratio;
    ivec2 first = ivec2(from + 1e-3);
    vec2 sum = vec2(0.0);
    float least = 3.0e38, weights = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 q = first + ivec2(i % 3, i / 3);
        vec2 covered = max(min(to, vec2(q + 1)) - max(from, vec2(q)), 0.0);
        vec2 z = imageLoad(finer, min(q, last)).xy;
        float weight = covered.x * covered.y;
        sum += weight * z;
        weights += weight;
        least = weight > 1e-3 && z.y > 0.0 ? min(least, z.x) : least;
    }
    vec2 nearest = least < 3.0e38 ? vec2(least, 1.0) : vec2(0.0);
    imageStore(coarser, p, vec4(kNearest ? nearest : sum / weights, 0.0, 0.0));
}
