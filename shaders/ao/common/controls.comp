// Intensity, power, floor and fading by distance of a method's visibility (runtime/ao/controls.h). In: linear depth, visibility. Out:
// visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View view; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r16f) uniform readonly image2D visibility;
layout(set = 0, binding = 3, r16f) uniform writeonly image2D result;
layout(push_constant) uniform Block { Controls constants; };

void main() {
    uvec2 p = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(p, view.visible))) return;
    float obscurance = 1.0 - imageLoad(visibility, ivec2(p)).x;
    float value = max(pow(max(1.0 - constants.intensity * obscurance, 0.0), constants.power), constants.lowest);
    float shown = clamp((constants.fadeTo - imageLoad(depth, ivec2(p + view.guard)).x) * constants.perFade, 0.0, 1.0);
    imageStore(result, ivec2(p), vec4(1.0 - shown * (1.0 - value)));
}
