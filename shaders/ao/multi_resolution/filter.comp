// Joint bilateral 3x3 filter of a level's obscurance [Hoang and Low 2012, table 4, with the weights of the text, normalised]: averages the
// interleaved samples of neighbours and smooths the maximum before it is passed to the finer level.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/multi_resolution/constants.h"
#include "ao/multi_resolution/levels.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, r32ui) uniform readonly uimage2D source;
layout(set = 0, binding = 4, r32ui) uniform readonly uimage2D sourceDirections;
layout(set = 0, binding = 5, r32ui) uniform writeonly uimage2D result;
layout(set = 0, binding = 6, r32ui) uniform writeonly uimage2D resultDirections;
layout(push_constant) uniform Block { MultiResolutionFilter constants; };

Surface surfaceAt(View view, ivec2 at) {
    return surfaceOf(view, (vec2(at) + 0.5) * constants.texel, imageLoad(depth, at).x, imageLoad(normals, at).x);
}

void main() {
    View view = viewBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = constants.area - 1;
    if (any(greaterThan(p, last))) return;
    Surface here = surfaceAt(view, constants.origin + p);
    Obscurance sum = Obscurance(vec3(0.0), vec3(0.0), 0.0);
    float weights = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 at = p + ivec2(x, y), q = clamp(at, ivec2(0), last);
            Surface there = surfaceAt(view, constants.origin + q);
            float w = alike(here, there, constants.perTolerance, constants.planes) / float((abs(x) + 1) * (abs(y) + 1));
            w = at == q ? w : 0.0;
            gather(sum, w, unpacked(uvec2(imageLoad(source, q).x, kDirected ? imageLoad(sourceDirections, q).x : 0u), there.n));
            weights += w;
        }
    }
    uvec2 bits = packed(Obscurance(sum.most / weights, sum.sum / weights, sum.count / weights), here.n);
    imageStore(result, p, uvec4(bits.x));
    if (kDirected) imageStore(resultDirections, p, uvec4(bits.y));
}
