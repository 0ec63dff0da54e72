// Normal rays through depth layers; surfaces have their rendered thickness.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant BENT
#define BENT_BINDING 8
#include "ao/common/packed_layers.glsl"
#include "ao/horizon_split/march.glsl"
struct Space {
    Lens lens;
    vec3 start;  // in homogeneous pixels, as rays are
};
#include "ao/horizon_split/normal_rays.glsl"
layout(set = 0, binding = 7, rgba32ui) uniform readonly uimage2D packedLayers;

Space spaceOf(View view, Origin origin) {
    Lens lens = lensOf(view);
    return Space(lens, toPixels(lens, origin.position));
}
vec3 towards(Space space, vec3 d) { return toPixels(space.lens, d); }

// Returns the middle of the first step that is blocked. A layer that a step crosses counts, however thin.
float blockedAt(Space space, vec3 ray, Steps walk, float first) {
    float result = kFree, before = 0.0, zBefore = space.start.z;
    float at = first;
    for (uint j = 0u; j < walk.count; ++j) {
        float l = metresAt(walk, at);
        vec3 q = space.start + l * ray;
        ivec2 texel;
        bool inside = texelOf(space.lens, q, texel);
        Layers layers = unpackLayers(imageLoad(packedLayers, texel));
        float near = min(q.z, zBefore), far = max(q.z, zBefore);
        bool hitsFirst = q.z > layers.first && near < layers.first + abs(layers.firstLength);
        bool hitsSecond = layers.second > 0.0 && far > layers.second && near < layers.second + abs(layers.secondLength);
        result = inside && (hitsFirst || hitsSecond) ? min(result, 0.5 * (l + before)) : result;
        before = l;
        zBefore = q.z;
        at += walk.part;
    }
    return result;
}
