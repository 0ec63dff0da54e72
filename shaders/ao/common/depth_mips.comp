// Levels of linear depth in one pass: a workgroup reduces 16x16 pixels. Layout: ao/common/depth_mips.glsl.
// kFarthest: mean of the texels that are not much nearer than the farthest of four, so that thin objects fade instead of growing [XeGTAO].
// Else one of the four, chosen by row and column [McGuire 2012, sec. 2.2]. In: linear depth, guard band included.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#include "ao/common/depth_mips.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 1, r32f) uniform writeonly image2D mips;
layout(push_constant) uniform Block { DepthMips constants; };
layout(constant_id = 0) const bool kFarthest = true;

shared float scratch[8][8];

float reduce(uvec2 texel, vec4 z) {  // z: of (0,0), (1,0), (0,1), (1,1)
    if (!kFarthest) {
        bool right = (texel.y & 1u) == 0u, lower = (texel.x & 1u) == 0u;
        vec2 row = lower ? z.zw : z.xy;
        return right ? row.y : row.x;
    }
    float farthest = max(max(z.x, z.y), max(z.z, z.w));
    vec4 w = clamp((constants.range - (farthest - z)) / (constants.fade * constants.range), 0.0, 1.0);
    return dot(w, z) / dot(w, vec4(1.0));
}

void main() {
    ivec2 last = constants.size - 1, padded = paddedSize(uvec2(last + 1)), quad = ivec2(gl_GlobalInvocationID.xy),
          own = ivec2(gl_LocalInvocationID.xy);
    vec4 z;
    for (int i = 0; i < 4; ++i) {
        ivec2 p = 2 * quad + ivec2(i & 1, i >> 1);
        z[i] = imageLoad(depth, min(p, last)).x;
        imageStore(mips, p, vec4(z[i]));
    }
    float reduced = reduce(uvec2(quad), z);
    imageStore(mips, mipTexel(padded, 2 * quad, 1), vec4(reduced));
    for (int level = 2; level < kDepthLevels; ++level) {
        int step = 1 << (level - 2);  // between the texels of the level before
        scratch[own.y][own.x] = reduced;
        barrier();
        if (all(equal(own & (2 * step - 1), ivec2(0)))) {
            z = vec4(reduced, scratch[own.y][own.x + step], scratch[own.y + step][own.x], scratch[own.y + step][own.x + step]);
            reduced = reduce(uvec2(quad >> (level - 1)), z);
            imageStore(mips, mipTexel(padded, 2 * quad, level), vec4(reduced));
        }
        barrier();
    }
}
