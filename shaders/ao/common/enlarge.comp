// Visibility of fewer pixels -> of all (runtime/ao/reduction.h). A pixel takes the bilinear mean of those of its four reduced neighbours
// that are on its surface; where none is, the one that is nearest to its plane. In: linear depth and normals of the frame
// and of the reduced pixels, visibility of these. Out: visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#include "ao/common/tile.glsl"
#include "shared/octahedral.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, std140) uniform ReducedBlock { View reducedBlock; };
layout(set = 0, binding = 4) uniform sampler2D reducedDepth;
layout(set = 0, binding = 5) uniform usampler2D reducedNormals;
layout(set = 0, binding = 6) uniform sampler2D visibility;
layout(set = 0, binding = 7, r16f) uniform writeonly image2D result;
layout(push_constant) uniform Block { Enlarge constants; };

void main() {
    View view = viewBlock, reduced = reducedBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), own = p + ivec2(view.guard);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    float z = imageLoad(depth, own).x;
    if (isSky(view, z)) {
        imageStore(result, p, vec4(1.0));
        return;
    }
    vec3 here = eyePosition(view, vec2(own) + 0.5, z), n = unpackNormal(imageLoad(normals, own).x);
    float tolerance = depthForTolerance(view, z);
    // Four neighbours, in the order of textureGather(): lower left, lower right, upper right, upper left.
    vec2 at = clamp(vec2(p) * constants.perScale, vec2(0.0), vec2(reduced.visible - 1u));
    vec2 corner = floor(at), f = at - corner;
    vec2 texel = corner + vec2(reduced.guard);
    vec4 zs = textureGather(reducedDepth, (texel + 1.0) / vec2(textureSize(reducedDepth, 0)));
    uvec4 packed = textureGather(reducedNormals, (texel + 1.0) / vec2(textureSize(reducedNormals, 0)));
    vec4 values = textureGather(visibility, (corner + 1.0) / vec2(textureSize(visibility, 0)));
    vec4 w = vec4((1.0 - f.x) * f.y, f.x * f.y, f.x * (1.0 - f.y), (1.0 - f.x) * (1.0 - f.y));
    vec4 off;
    for (int i = 0; i < 4; ++i) {
        // What lies beyond the view, in an image that may be larger, is of another frame.
        vec2 step = vec2(i == 1 || i == 2, i < 2);
        bool inside = all(lessThan(corner + step, vec2(reduced.visible)));
        values[i] = inside ? values[i] : 0.0;
        off[i] = inside ? abs(dot(eyePosition(reduced, texel + step + 0.5, zs[i]) - here, n)) : 1e30;
        bool same = inside && !isSky(reduced, zs[i]) && off[i] < 0.01 * tolerance && dot(n, unpackNormal(packed[i])) > 0.5;
        w[i] = same ? max(w[i], 1e-4) : 0.0;
    }
    if (w == vec4(0.0)) w = vec4(equal(off, vec4(min(min(off.x, off.y), min(off.z, off.w)))));
    float value = dot(w, values) / dot(w, vec4(1.0));
    imageStore(result, p, vec4(value));
}
