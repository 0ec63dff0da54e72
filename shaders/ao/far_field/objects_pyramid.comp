// Lateral pyramid of objects: a cell of level n is the mean of four cells of level n - 1.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/far_field/constants.h"
#include "ao/far_field/grid.glsl"
#include "ao/far_field/objects.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Directions { Direction directionsOf[]; };
layout(set = 0, binding = 1, rg32ui) uniform uimage2D cells;
layout(push_constant) uniform Block { FarFieldObjectPyramid constants; };

void main() {
    Direction d = directionsOf[constants.first + gl_GlobalInvocationID.z];
    uint line = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y, lines = d.lines >> constants.level,
         below = d.lines >> (constants.level - 1u);
    if (line >= lines || j >= d.intervals >> constants.level) return;
    uint from = levelBase(d, constants.level - 1u, kPyramid) + 2u * j * below + 2u * line;
    vec4 sum = unpackObject(imageLoad(cells, texelOf(from)).xy) + unpackObject(imageLoad(cells, texelOf(from + 1u)).xy) +
               unpackObject(imageLoad(cells, texelOf(from + below)).xy) + unpackObject(imageLoad(cells, texelOf(from + below + 1u)).xy);
    imageStore(cells, texelOf(levelBase(d, constants.level, kPyramid) + j * lines + line), uvec4(packObject(0.25 * sum), 0u, 0u));
}
