// Splits depth layers into two fields. Background: endless surfaces, which are scanned for horizons like a single depth buffer: surfaces
// without a known back and without a second layer, and open sheets behind a solid (a sheet behind a sheet is not background: leaves in
// front of leaves). Objects: surfaces with a known back; they block only between front and back.
// In: depth, normals, depth layers. Out: linear depth of the background; objects (objects.glsl), zeros without one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/layers_at.glsl"
#include "ao/far_field/constants.h"
#include "ao/far_field/objects.glsl"
layout(set = 0, binding = 5, r32f) uniform writeonly image2D background;
layout(set = 0, binding = 6, rg32ui) uniform writeonly uimage2D objects;
layout(push_constant) uniform Block { FarFieldFields constants; };

void main() {
    View view = viewBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.size)))) return;
    vec3 n;
    Layers s = layersOfPixel(view, constants.layers, p, n);
    bool last = s.firstLength <= -kEndless || (s.firstLength < 0.0 && s.second <= 0.0) || isSky(view, s.first);
    bool behind = s.firstLength > 0.0 && s.second > 0.0 && s.secondLength < 0.0;
    imageStore(background, p, vec4(last ? s.first : behind ? s.second : view.skyDepth));
    // The front is a plane, so unit / depth is linear over the image.
    n = normalize(n);
    vec3 position = eyePosition(view, vec2(p) + 0.5, s.first);
    float away = view.orthographic > 0.5 ? -n.z * s.first * s.first : dot(n, position), front = constants.unit / s.first;
    vec2 growth = n.xy * view.unproject.xy * constants.unit / (abs(away) > 1e-12 ? away : 1e-12);
    // The slope per pixel is at most the thickness, for fronts that curve away.
    float back = constants.unit / (s.first + abs(s.firstLength)), most = front - back;
    imageStore(objects, p, last ? uvec4(0u) : uvec4(packSurface(front, back), packHalf2x16(clamp(growth, -most, most)), 0u, 0u));
}
