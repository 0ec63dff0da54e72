// Joint bilateral upsampling and combination of two levels [Hoang and Low 2012, fig. 9, eq. 8-10], for combine.comp and finish.comp.
#include "ao/multi_resolution/constants.h"
#include "ao/multi_resolution/levels.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
#ifdef GATHERED
layout(set = 0, binding = 3, r16f) uniform readonly image2D near;  // visibility
#else
layout(set = 0, binding = 3, r32ui) uniform readonly uimage2D near;
#endif
layout(set = 0, binding = 4, r32f) uniform readonly image2D coarseDepth;
layout(set = 0, binding = 5, r32ui) uniform readonly uimage2D coarseNormals;
layout(set = 0, binding = 6, r32ui) uniform readonly uimage2D coarse;
layout(set = 0, binding = 7, r32ui) uniform readonly uimage2D coarseDirections;
layout(push_constant) uniform Block { MultiResolutionUpsample constants; };

#ifdef GATHERED
Obscurance ownOf(ivec2 p, vec3 n) {
    vec3 mean = (1.0 - imageLoad(near, p).x) * (kDirected ? n : vec3(1, 0, 0));
    return Obscurance(mean, mean * constants.samples, constants.samples);
}
#else
Obscurance ownOf(ivec2 p, vec3 n) { return unpackedOwn(imageLoad(near, p).x, n); }
#endif

Obscurance combined(View view, ivec2 p, Surface here, Obscurance own) {
    ivec2 at = constants.origin + p, first = (at - 1) >> 1;  // of the four texels around p
    Obscurance far = Obscurance(vec3(0.0), vec3(0.0), 0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 q = first + ivec2(i & 1, i >> 1);
        vec2 apart = abs(vec2(at) - 2.0 * vec2(q) - 0.5);  // 0.5 or 1.5: bilinear 3/4 or 1/4
        q = clamp(q, constants.coarseOrigin, constants.coarseOrigin + constants.coarseArea - 1);
        vec2 centre = (2.0 * vec2(q) + 1.0) * constants.texel;
        Surface there = surfaceOf(view, centre, imageLoad(coarseDepth, q).x, imageLoad(coarseNormals, q).x);
        float w = alike(here, there, constants.perTolerance, constants.planes) * (1.0 - 0.5 * apart.x) * (1.0 - 0.5 * apart.y);
        ivec2 texelOfArea = q - constants.coarseOrigin;
        gather(far, w,
            unpacked(uvec2(imageLoad(coarse, texelOfArea).x, kDirected ? imageLoad(coarseDirections, texelOfArea).x : 0u), there.n));
        weights += w;
    }
    float scale = weights > 1e-20 ? 1.0 / weights : 0.0;
    vec3 most = far.most * scale;
    return Obscurance(
        along(own.most, here.n) > along(most, here.n) ? own.most : most, own.sum + scale * far.sum, own.count + scale * far.count);
}
