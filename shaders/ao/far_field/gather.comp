// Gather: a pixel's own near field and the far field of the neighbours that its box average accepted.
// In: averaged surfaces, visibility of the near field, far obscurance times sector widths. Out: visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, rg32ui) uniform readonly uimage2D surfaces;
layout(set = 0, binding = 2, r16f) uniform readonly image2D near;
layout(set = 0, binding = 3, rg16f) uniform readonly image2D parts;
layout(set = 0, binding = 4, r16f) uniform writeonly image2D visibility;

void main() {
    uvec2 visible = viewBlock.visible;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(visible)))) return;
    uint mask = imageLoad(surfaces, p).y & 511u;
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 9; ++i) {
        ivec2 q = clamp(p + ivec2(i % 3 - 1, i / 3 - 1), ivec2(0), ivec2(visible) - 1);
        sum += (mask >> i & 1u) != 0u ? imageLoad(parts, q).xy : vec2(0.0);
    }
    float far = 2.0 * sum.x / max(sum.y, 1e-6);  // by the widths that were gathered, in case some sectors were not
    imageStore(visibility, p, vec4(clamp(imageLoad(near, p).x - far, 0.0, 1.0)));
}
