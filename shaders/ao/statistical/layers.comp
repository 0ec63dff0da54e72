// Layer of each texel, one bit per level [Hendrickx, sec. 5, alg. 1]: set if the texel is nearer than the mean depth of its layer over its
// window. At level 0: the number of its uniform layer [sec. 4].
// In: texels, codes and tables of the previous levels (unused ones are bound to the root). Out: codes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/statistical/constants.h"
#include "ao/statistical/fixed_point.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, std430) readonly buffer ExtentBlock { Extent extent; };
layout(set = 0, binding = 2, std430) readonly buffer Texels { uvec4 texels[]; };
layout(set = 0, binding = 3, std430) readonly buffer Root { uvec4 root[]; };
layout(set = 0, binding = 4, std430) readonly buffer First { uvec4 first[]; };
layout(set = 0, binding = 5, std430) readonly buffer Second { uvec4 second[]; };
layout(set = 0, binding = 6, std430) buffer Codes { uint codes[]; };
layout(push_constant) uniform Block { StatisticalLayers constants; };
layout(constant_id = 0) const uint level = 1;

// Sum of z and count over a window of table[LAYERS x entry + LAYER]; corners as indices of entries.
#define WINDOW(table, layers, layer) (table[corner.w * layers + layer].zw - table[corner.y * layers + layer].zw \
                                    - table[corner.z * layers + layer].zw + table[corner.x * layers + layer].zw)

void main() {
    View view = viewBlock;
    Box box = constants.box;
    uvec2 t = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(t, constants.size))) return;
    uint at = t.y * constants.size.x + t.x;
    ivec2 texel = ivec2(texels[at].zw);
    if (texel.y == 0) {
        codes[at] = 0u;
        return;
    }
    float units = unitsPerMetre(view, box, extent);
    float d = -float(texel.x) / float(texel.y), z = d / units + originOf(view, extent);  // d: in units
    if (level == 0u) {
        float near = nearestDepth(extent), far = min(uintBitsToFloat(extent.furthest), originOf(view, extent) + box.limit);
        float count = float(constants.uniformLayers);
        codes[at] = uint(clamp((z - near) / max(far - near, 1e-6) * count, 0.0, count - 1.0));
        return;
    }

    // Whole texels: fractions of texels at the window's edge do not matter for the split.
    vec2 reach = halfWindow(view, box, z) / float(box.texelSide) * vec2(box.columns, 1.0);
    ivec2 low = clamp(ivec2(round(vec2(ivec2(t)) + 0.5 - reach)), ivec2(0), ivec2(t));
    ivec2 high = clamp(ivec2(round(vec2(ivec2(t)) + 0.5 + reach)), ivec2(t) + 1, ivec2(constants.size));
    uint pitch = constants.size.x + 1u;
    uvec2 rows = uvec2(low.y, high.y) * pitch, columns = uvec2(low.x, high.x);
    uvec4 corner = uvec4(rows.x + columns, rows.y + columns);
    uvec2 sum = WINDOW(root, 1u, 0u);
    uint code = level > 1u ? codes[at] : 0u;
    if (level >= 2u) {
        uvec2 near = WINDOW(first, 1u, 0u);
        sum = (code & 1u) != 0u ? near : sum - near;
    }
    if (level == 3u) {
        uint branch = (code & 1u) != 0u ? 0u : 1u;
        uvec2 nearer = WINDOW(second, 2u, branch);
        sum = (code & 2u) != 0u ? nearer : sum - nearer;
    }
    bool isNearer = d < -float(int(sum.x)) / float(int(sum.y));  // the sum contains the texel itself, so it is not empty
    codes[at] = code | (isNearer ? 1u << (level - 1u) : 0u);
}
