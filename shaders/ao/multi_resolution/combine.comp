// Combines a level's own obscurance with that of all coarser levels. In: depth and packed normals of this and the next coarser level, own
// obscurance, filtered obscurance of the coarser level. Out: an Obscurance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/multi_resolution/upsample.glsl"
layout(set = 0, binding = 8, r32ui) uniform readonly uimage2D nearDirections;
layout(set = 0, binding = 9, r32ui) uniform writeonly uimage2D result;
layout(set = 0, binding = 10, r32ui) uniform writeonly uimage2D resultDirections;

void main() {
    View view = viewBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, constants.area))) return;
    ivec2 at = constants.origin + p;
    Surface here = surfaceOf(view, (vec2(at) + 0.5) * constants.texel, imageLoad(depth, at).x, imageLoad(normals, at).x);
    Obscurance own = unpacked(uvec2(imageLoad(near, p).x, kDirected ? imageLoad(nearDirections, p).x : 0u), here.n);
    uvec2 bits = packed(combined(view, p, here, own), here.n);
    imageStore(result, p, uvec4(bits.x));
    if (kDirected) imageStore(resultDirections, p, uvec4(bits.y));
}
