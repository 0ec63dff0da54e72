// Far obscurance of the sectors that are this pixel's: share g of the tile's n^2 is g, g + n^2, g + 2 n^2 ... [Timonen 2013, sec. 10].
// In: linear depth, averaged surfaces, directions, cells, the falloff's table. Out: far obscurance times sector widths, and these.
#include "ao/common/tile.glsl"
#include "ao/far_field/layout.h"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
const uint kThin = 0u;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, rg32ui) uniform readonly uimage2D surfaces;
layout(set = 0, binding = 3, std430) readonly buffer Directions { Direction directionsOf[]; };
#define CELLS_BINDING 4
#define CELLS_ACCESS readonly
#include "ao/far_field/cells.glsl"
layout(set = 0, binding = 5, rgba32ui) uniform readonly uimage2D table;
layout(set = 0, binding = 6, rg16f) uniform writeonly image2D parts;
layout(push_constant) uniform Constants { FarFieldConstants constants; };
#include "ao/far_field/sectors.glsl"

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    FarFieldConstants c = constants;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    uvec2 surface = imageLoad(surfaces, p).xy;
    float z = uintBitsToFloat(surface.y);
    vec2 sum = vec2(0.0);
    if (!isSky(view, z)) {
        Receiver r = receiverAt(view, p + ivec2(view.guard), z, unpackNormal(surface.x));
        Turn turn = turnOf(c);
        for (uint k = shareOf(view, p, c.side); k < c.directions; k += c.side * c.side) sum += sectorOf(r, k, c, turn, view.skyDepth);
    }
    imageStore(parts, p, vec4(2.0 * sum.x, sum.y, 0.0, 0.0));
}
