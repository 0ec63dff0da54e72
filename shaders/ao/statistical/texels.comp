// Downsampling: texel = (sum x, sum y, sum z, count) over its pixels that are not sky, in fixed point [Hendrickx, sec. 7.1].
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
    float units = unitsPerMetre(view, box, extent);
    uint side = box.texelSide;
    ivec4 sum = ivec4(0);
    for (uint y = 0u; y < side; ++y) {
        for (uint x = 0u; x < side; ++x) {
            uvec2 at = t * side + uvec2(x, y), p = min(at, view.size - 1u);
            float z = imageLoad(depth, ivec2(p)).x;
            bool counts = at == p && !isSky(view, z);
            ivec3 here = ivec3(round(eyePosition(view, vec2(p) + 0.5, counts ? z : 0.0) * units));
            sum += counts ? ivec4(here, 1) : ivec4(0);
        }
    }
    texels[t.y * constants.size.x + t.x] = uvec4(sum);
}
