// Line samples through a ball around each pixel; a line is occupied behind the depth buffer. See
// runtime/ao/methods/volumetric/volumetric.cpp. In: linear depth, packed normals, guard band included. Out: visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/tile.glsl"
#include "ao/volumetric/constants.h"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Block { VolumetricLines constants; };

// Volume along a texel's ray from the centre's depth to g metres behind it. The texel's width grows by `widens` per metre (0 for the whole
// ball, whose halves must be equal).
float volume(float g, float widens) {
    float x = g * widens;
    return g * (1.0 + x + x * x / 3.0);
}

void main() {
    View view = viewBlock;  // copies, so that the loop holds them in registers
    float r = constants.radius, thick = constants.thickness;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = ivec2(view.size) - 1;
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 texel = p + ivec2(view.guard);
    float z = imageLoad(depth, texel).x;
    if (isSky(view, z)) {
        imageStore(visibility, p, vec4(1.0));
        return;
    }
    vec3 here = eyePosition(view, vec2(texel) + 0.5, z), n = unpackNormal(imageLoad(normals, texel).x);
    n = dot(n, towardsEye(view, here)) < 0.0 ? -n : n;
    vec3 centre = constants.solid == 2u ? here + r * n : here;
    float centreDepth = -centre.z;
    bool halfBall = constants.solid == 1u, orthographic = view.orthographic > 0.5;
    float scale = view.pixelsPerMetre / (orthographic ? 1.0 : max(-centre.z, 0.05 * z)) * r;  // rows of the radius
    vec2 centrePixel = constants.solid == 2u ? pixelOf(view, vec3(centre.xy, min(centre.z, -0.05 * z))) : vec2(texel) + 0.5;
    float widens = orthographic || constants.solid == 0u ? 0.0 : 1.0 / max(centreDepth, 0.05 * z);
    float turn = 6.28318531 * fract((float(bayer16(uvec2(p))) + 0.5) / 16.0 + frameShift(view).x);
    float whole = 0.0, occupied = 0.0;
    for (uint i = 0u;;) {
        float angle = turn + 2.39996323 * float(i);
        vec2 at = centrePixel + scale * sqrt((float(i) + 0.5) / float(constants.lines)) * vec2(constants.columns * cos(angle), sin(angle));
        ivec2 q = clamp(ivec2(floor(at)), ivec2(0), last);
        // The texel's view ray relative to the centre: points from + g along, with g the depth behind the centre. It is in the ball from g0
        // to g1.
        vec2 ray = (vec2(q) + 0.5) * view.unproject.xy + view.unproject.zw;
        vec3 from = vec3(ray * (orthographic ? 1.0 : centreDepth) - centre.xy, 0.0), along = vec3(orthographic ? vec2(0.0) : ray, -1.0);
        float a = dot(along, along), b = dot(from, along), inside = b * b - a * (dot(from, from) - r * r), root = sqrt(max(inside, 0.0));
        float g0 = (-b - root) / a, g1 = (-b + root) / a;
        float speed = dot(n, along), plane = dot(n, here - centre - from) / (abs(speed) > 1e-6 ? speed : 1e-6);
        g1 = halfBall && speed < 0.0 ? min(g1, plane) : g1;
        g0 = halfBall && speed >= 0.0 ? max(g0, plane) : g0;
        float gq = imageLoad(depth, q).x - centreDepth, weight = inside > 0.0 && g1 > g0 ? 1.0 : 0.0;
        whole += weight * (volume(g1, widens) - volume(g0, widens));
        occupied += weight * max(volume(min(g1, gq + thick), widens) - volume(max(g0, gq), widens), 0.0);
        if (++i >= constants.lines) break;
    }
    float blocked = whole > 0.0 ? occupied / whole : 0.0;
    imageStore(visibility, p, vec4(clamp(1.0 - (constants.solid == 0u ? 2.0 * blocked - 1.0 : blocked), 0.0, 1.0)));
}
