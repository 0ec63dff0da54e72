// 5x5 bilateral blur of visibility: Gaussian (6, 4, 1) x max(0, n.n') x 1/(1 + 200 plane distance / depth). The
// plane distance is the neighbour's from this pixel's tangent plane, so slanted floors are not edges.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, r16f) uniform readonly image2D source;
layout(set = 0, binding = 4, r16f) uniform writeonly image2D result;

const float kPlane = 200.0;         // per unit of plane distance / depth: 40 per metre at 5 m
const float kStrictPlane = 1600.0;  // kStrict, with history: cosines of normals are then raised to the power 8
layout(constant_id = 0) const bool kStrict = false;

void main() {
    View view = viewBlock;  // a copy, so that the loop holds it in registers
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 guard = ivec2(view.guard);
    float z = imageLoad(depth, p + guard).x;
    if (isSky(view, z)) {
        imageStore(result, p, vec4(1.0));
        return;
    }
    vec3 n = unpackNormal(imageLoad(normals, p + guard).x);
    // A neighbour's plane distance is depth (r.n) - here.n with r its view ray; r.n is linear over the image.
    vec2 along = view.unproject.xy * n.xy;
    float ray = dot(vec2(p + guard) + 0.5, along) + dot(view.unproject.zw, n.xy);
    bool orthographic = view.orthographic > 0.5;
    float height = (orthographic ? ray : ray * z) - z * n.z;
    float sharpness = (kStrict ? kStrictPlane : kPlane) / depthForTolerance(view, z);
    const float kernel[3] = {6.0, 4.0, 1.0};
    float sum = 0.0, weights = 0.0;
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            ivec2 q = p + ivec2(x, y);
            bool inside = all(greaterThanEqual(q, ivec2(0))) && all(lessThan(q, ivec2(view.visible)));
            q = clamp(q, ivec2(0), ivec2(view.visible) - 1);
            float zq = imageLoad(depth, q + guard).x;
            float rayThere = ray + dot(vec2(q - p), along);
            float plane = abs((orthographic ? rayThere : rayThere * zq) - zq * n.z - height);
            vec3 m = directionOf(imageLoad(normals, q + guard).x);
            float cosine = max(0.0, dot(n, m)), square = dot(m, m), soft = 1.0 + sharpness * plane;
            float w = kernel[abs(x)] * kernel[abs(y)];
            if (kStrict) {
                float cosine2 = cosine * cosine / square;
                cosine2 *= cosine2;  // the power 4
                w *= cosine2 * cosine2 / soft;
            } else {
                w *= cosine / (sqrt(square) * soft);
            }
            w = inside ? w : 0.0;
            sum += w * imageLoad(source, q).x;
            weights += w;
        }
    }
    imageStore(result, p, vec4(weights > 0.0 ? sum / weights : imageLoad(source, p).x));
}
