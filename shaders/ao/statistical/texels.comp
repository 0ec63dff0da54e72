// Downsampling: texel = (sum x, sum y, sum z, count) over its pixels that are not open, in fixed point [Hendrickx, sec. 7.1]. Edge pixels
// are repeated where the frame ends in a texel.
// Sums, not means, so that counts stay exact. In: linear depth, the frame's extent. Out: texels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/statistical/constants.h"
#include "ao/statistical/fixed_point.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, std430) readonly buffer ExtentBlock { Extent extent; };
layout(set = 0, binding = 3, std430) writeonly buffer Texels { uvec4 texels[]; };
layout(push_constant) uniform Block { StatisticalTexels constants; };

void main() {
    View view = viewBlock;
    Box box = constants.box;
    uvec2 t = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(t, constants.size))) return;
    float units = unitsPerMetre(view, box, extent), origin = originOf(view, extent);
    uint side = box.texelSide, count = 0u;
    vec3 sum = vec3(0.0);
    for (uint y = 0u; y < side; ++y) {
        for (uint x = 0u; x < side; ++x) {
            uvec2 p = min(t * side + uvec2(x, y), view.size - 1u);
            float z = imageLoad(depth, ivec2(p)).x;
            vec3 here = eyePosition(view, vec2(p) + 0.5, z);
            bool counts = !isOpen(view, box, origin, here, z);
            sum += counts ? vec3(here.xy, origin - z) : vec3(0.0);
            count += counts ? 1u : 0u;
        }
    }
    texels[t.y * constants.size.x + t.x] = uvec4(ivec4(round(sum * units), count));
}
