// View: sizes and projection of a frame, for all methods. Pixels count from the upper left of the buffers, guard band included. Eye space
// is right-handed, camera at the origin looking down -z, y up, metres. Linear depth is -z.
#ifndef OBSCURA_SHARED_VIEW_H
#define OBSCURA_SHARED_VIEW_H
#include "types.h"
OBSCURA_SHARED_BEGIN

struct View {
    uvec2 size;          // of the buffers, px
    uvec2 visible;       // of the part that is shown, px
    uvec2 guard;         // where the visible part begins, px
    float pixelsPerMetre;  // of a length parallel to the image, at linear depth 1 m (perspective) or at any depth (orthographic)
    float orthographic;  // 1 or 0
    vec4 unproject;      // eye.xy = (pixelCentre * unproject.xy + unproject.zw) * (orthographic ? 1 : depth)
    vec4 project;        // pixelCentre = eye.xy / (orthographic ? 1 : depth) * project.xy + project.zw
    vec4 linearize;      // linear depth = (d * x + y) / (d * z + w), d the device depth in [0,1]
    uint frame;          // frame number; selects the rotation of samples
    uint temporal;       // 1: samples rotate over frames, because history averages them
    float skyDepth;      // linear depth at or beyond which a pixel is sky
    float orthographicDepth;  // orthographic: linear depth at which a perspective view of 60 degrees has the same height, m; else 0
};
OBSCURA_SHARED_SIZE(View, 96);

OBSCURA_SHARED_END

#ifndef __cplusplus
vec3 eyePosition(View view, vec2 pixelCentre, float depth) {
    vec2 xy = pixelCentre * view.unproject.xy + view.unproject.zw;
    return vec3(xy * (view.orthographic > 0.5 ? 1.0 : depth), -depth);
}
vec2 pixelOf(View view, vec3 eye) {
    vec2 xy = view.orthographic > 0.5 ? eye.xy : eye.xy / -eye.z;
    return xy * view.project.xy + view.project.zw;
}
// Unit vector from an eye-space point towards the camera.
vec3 towardsEye(View view, vec3 eye) { return view.orthographic > 0.5 ? vec3(0, 0, 1) : normalize(-eye); }
// Depth for tolerances that are relative to depth. That of an orthographic view is measured from a plane anywhere, so it has a fixed one.
float depthForTolerance(View view, float depth) { return view.orthographic > 0.5 ? view.orthographicDepth : depth; }
bool isSky(View view, float depth) { return depth >= view.skyDepth; }
// This frame's shift of noise in [0,1)^3: the additive sequence R3 [Roberts 2018, The Unreasonable Effectiveness of Quasirandom
// Sequences]. Zero without temporal reprojection.
vec3 frameShift(View view) {
    return view.temporal != 0u ? fract(float(view.frame & 1023u) * vec3(0.8191725134, 0.6710436067, 0.5497004779)) : vec3(0.0);
}
#endif

#endif
