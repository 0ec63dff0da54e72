// Normal rays through the depth buffer; surfaces have a constant thickness.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant BENT
#define BENT_BINDING 7
#include "ao/horizon_split/march.glsl"
struct Space {
    Lens lens;
    vec3 start;  // in homogeneous pixels, as rays are
};
#include "ao/horizon_split/normal_rays.glsl"

Space spaceOf(View view, Origin origin) {
    Lens lens = lensOf(view);
    return Space(lens, toPixels(lens, origin.position));
}
vec3 towards(Space space, vec3 d) { return toPixels(space.lens, d); }

// Returns the middle of the first step that is blocked.
float blockedAt(Space space, vec3 ray, Steps walk, float first) {
    float result = kFree, before = 0.0;
    float at = first;
    for (uint j = 0u; j < walk.count; ++j) {
        float l = metresAt(walk, at);
        vec3 q = space.start + l * ray;
        ivec2 texel;
        bool inside = texelOf(space.lens, q, texel);
        float behind = q.z - imageLoad(depth, texel).x;
        result = inside && behind > 0.0 && behind < walk.thickness ? min(result, 0.5 * (l + before)) : result;
        before = l;
        at += walk.part;
    }
    return result;
}
