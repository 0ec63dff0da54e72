// Depth layers in two fields. The background is what goes on without end, as single layers do, so it is scanned for horizons: the ground, walls,
// any surface of which no end is known and behind which there is none, or that is seen behind a solid; not a sheet behind a sheet: leaves hang
// before leaves. What ends is a thing: it is met where it is, and what lies behind stays open.
// In: depth, normals, depth layers. Out: the background's linear depth; of things, as halves, unit / depth of front and back, and how much
// the former grows a pixel to the right and downwards; zeros where there is none.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/spans_at.glsl"
layout(set = 0, binding = 5, r32f) uniform writeonly image2D background;
layout(set = 0, binding = 6, rg32ui) uniform writeonly uimage2D things;
layout(push_constant) uniform Constants {
    Packing packing;
    float unit;  // metres: the falloff's length
};

void main() {
    View view = viewBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.size)))) return;
    uint normal;
    Spans s = spansAt(view, packing, p, normal);
    bool last = s.firstLength <= -kEndless || (s.firstLength < 0.0 && s.second <= 0.0) || isSky(view, s.first);
    bool behind = s.firstLength > 0.0 && s.second > 0.0 && s.secondLength < 0.0;
    imageStore(background, p, vec4(last ? s.first : behind ? s.second : view.skyDepth));
    // The front is a plane: unit / depth is linear over the picture.
    vec3 n = unpackNormal(normal), position = eyePosition(view, vec2(p) + 0.5, s.first);
    float away = view.orthographic > 0.5 ? -n.z * s.first * s.first : dot(n, position), front = unit / s.first;
    vec2 growth = n.xy * view.unproject.xy * unit / (abs(away) > 1e-12 ? away : 1e-12);
    // Where the front curves away it is no more slanted than it is thick.
    float back = unit / (s.first + abs(s.firstLength)), most = front - back;
    imageStore(things, p, last ? uvec4(0u) : uvec4(packHalf2x16(vec2(front, back)), packHalf2x16(clamp(growth, -most, most)), 0u, 0u));
}
