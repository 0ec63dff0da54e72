// Means of objects over the shortest intervals of every line, along one of each two opposite directions. Pixels outside the image repeat
// its edge, so that walls do not fade there.
// In: objects (fields.comp), directions. Out: cells of objects.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/far_field/grid.glsl"
#include "ao/far_field/objects.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, rg32ui) uniform readonly uimage2D objects;
layout(set = 0, binding = 2, std430) readonly buffer Directions { Direction directionsOf[]; };
layout(set = 0, binding = 3, rg32ui) uniform writeonly uimage2D cells;
layout(push_constant) uniform Block { FarFieldConstants constants; };

void main() {
    View view = viewBlock;  // copies, so that the loop holds them in registers
    FarFieldConstants c = constants;
    Direction d = directionsOf[c.first + gl_GlobalInvocationID.z];
    uint line = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y, steps = uint(c.interval);
    if (line >= d.lines || j >= d.intervals) return;
    float across = (float(line) + 0.5) * c.lineStep - d.origin.y, first = middleOf(d, c.interval, j) - 0.5 * c.interval + 0.5;
    vec2 at = vec2(view.size) * 0.5 + d.along * first + vec2(-d.along.y, d.along.x) * across;
    ivec2 last = ivec2(view.size) - 1;
    vec4 sum = vec4(0.0);
    for (uint i = 0u;;) {
        uvec2 texel = imageLoad(objects, clamp(ivec2(at), ivec2(0), last)).xy;
        sum += texel.x != 0u ? vec4(unpackSurface(texel.x), 1.0, dot(unpackHalf2x16(texel.y), d.along)) : vec4(0.0);
        at += d.along;
        if (++i >= steps) break;
    }
    sum.xyz /= c.interval;  // means; w stays the growth of the front over the interval
    imageStore(cells, texelOf(levelBase(d, 0u, kPyramid) + j * d.lines + line), uvec4(packObject(sum), 0u, 0u));
}
