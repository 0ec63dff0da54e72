// Eye-space lines in homogeneous pixel coordinates, so that a step costs two additions and one division.
#ifndef OBSCURA_LENS_GLSL
#define OBSCURA_LENS_GLSL
#include "shared/view.h"

// Projection parameters. scale(depth), the width of the view in units of that at depth 1: depth, or 1 if orthographic.
struct Lens {
    vec4 project, unproject;
    vec2 scale;     // scale(depth) = depth * x + y
    uvec2 size;
};
Lens lensOf(View view) {
    return Lens(view.project, view.unproject, view.orthographic > 0.5 ? vec2(0, 1) : vec2(1, 0), view.size);
}
vec3 toPixels(Lens lens, vec3 v) { return vec3(v.xy * lens.project.xy, -v.z); }
// The texel of a homogeneous point, clamped to the buffer. Returns whether it is in front of the camera and inside the buffer or less than
// a pixel beyond an edge: the conversion takes -0.5 for texel 0, so the other sides are as wide, and pictures mirror.
bool texelOf(Lens lens, vec3 q, out ivec2 texel) {
    vec2 at = q.xy / (q.z * lens.scale.x + lens.scale.y) + lens.project.zw;
    uvec2 t = uvec2(ivec2(at));
    texel = ivec2(min(t, lens.size - 1u));
    return t.x <= lens.size.x && t.y <= lens.size.y && q.z > 0.0;
}
vec3 surfaceAt(Lens lens, ivec2 texel, float z) {
    return vec3(((vec2(texel) + 0.5) * lens.unproject.xy + lens.unproject.zw) * (z * lens.scale.x + lens.scale.y), -z);
}

#endif
