// Next coarser level of depth and normals [Hoang and Low 2012, table 2]: the median of four texels, or the second nearest if their depths
// differ by more than a threshold. In: depth and packed normals of a level. Out: those of the next, half the size, rounded up.
//
// The paper keeps positions. Here the chosen texel's depth is moved along its tangent plane to the middle of the four, so that depth is
// enough and planes stay planes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/multi_resolution/constants.h"
#include "ao/multi_resolution/levels.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, r32f) uniform writeonly image2D coarseDepth;
layout(set = 0, binding = 4, r32ui) uniform writeonly uimage2D coarseNormals;
layout(push_constant) uniform Block { MultiResolutionDownsample constants; };

struct Texel {
    float z;
    ivec2 at;
};
void order(inout Texel a, inout Texel b) {
    bool swap = b.z < a.z;
    Texel nearer = Texel(swap ? b.z : a.z, swap ? b.at : a.at);
    b = Texel(swap ? a.z : b.z, swap ? a.at : b.at);
    a = nearer;
}

// Depth at pixel `to` of the plane with normal n through pixel `from` at depth z.
float depthOnPlane(View view, vec2 from, vec2 to, float z, vec3 n) {
    vec2 xy = to * view.unproject.xy + view.unproject.zw;
    bool orthographic = view.orthographic > 0.5;
    float offset = dot(n, eyePosition(view, from, z)) - (orthographic ? dot(n.xy, xy) : 0.0),
          slope = (orthographic ? 0.0 : dot(n.xy, xy)) - n.z;
    return abs(slope) > 1e-6 ? offset / slope : z;
}

void main() {
    View view = viewBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, constants.coarseSize))) return;
    ivec2 last = constants.size - 1;
    Texel t[4];
    for (int i = 0; i < 4; ++i) {
        t[i].at = min(2 * p + ivec2(i & 1, i >> 1), last);
        t[i].z = imageLoad(depth, t[i].at).x;
    }
    order(t[0], t[1]);
    order(t[2], t[3]);
    order(t[0], t[2]);
    order(t[1], t[3]);
    order(t[1], t[2]);
    bool median = t[3].z - t[0].z <= constants.threshold;
    vec3 n1 = unpackNormal(imageLoad(normals, t[1].at).x), n2 = unpackNormal(imageLoad(normals, t[2].at).x);
    vec2 middle = (2.0 * vec2(p) + 1.0) * constants.texel;
    // On a plane the middle is between the two depths; the clamp limits errors of slanted normals.
    float z1 = clamp(depthOnPlane(view, (vec2(t[1].at) + 0.5) * constants.texel, middle, t[1].z, n1), t[1].z, t[2].z);
    float z2 = clamp(depthOnPlane(view, (vec2(t[2].at) + 0.5) * constants.texel, middle, t[2].z, n2), t[1].z, t[2].z);
    vec3 both = n1 + n2;
    imageStore(coarseDepth, p, vec4(median ? 0.5 * (z1 + z2) : z1));
    imageStore(coarseNormals, p, uvec4(packNormal(median && dot(both, both) > 1e-6 ? normalize(both) : n1)));
}
