// Level 0 of the depth pyramid.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 1, r32f) uniform writeonly image2D base;

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(p, imageSize(base)))) imageStore(base, p, imageLoad(depth, p));
}
