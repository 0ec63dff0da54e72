// 3x3 blur that stops at edges [XeGTAO]; two passes make its 5x5 blur. Pixels with edges on most sides still blur a little.
// In: visibility and edges. Out: the same, or with kLast visibility.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#include "ao/common/edges.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32ui) uniform readonly uimage2D noisy;
layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D intermediate;
layout(set = 0, binding = 2, r16f) uniform writeonly image2D visibility;
layout(push_constant) uniform Block { EdgeBlur constants; };
layout(constant_id = 0) const bool kLast = true;

const float kDiagonal = 0.85 * 0.5;
const float kLeakFrom = 1.5, kLeak = 0.5;  // if fewer than kLeakFrom sides are connected, all are raised by up to kLeak

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = constants.size - 1;
    if (any(greaterThan(p, last))) return;
    ivec2 low = max(p - 1, 0), high = min(p + 1, last);
    uint c = imageLoad(noisy, p).x;
    uint l = imageLoad(noisy, ivec2(low.x, p.y)).x, r = imageLoad(noisy, ivec2(high.x, p.y)).x;
    uint t = imageLoad(noisy, ivec2(p.x, low.y)).x, b = imageLoad(noisy, ivec2(p.x, high.y)).x;
    // left, right, top, bottom: connected if both pixels say so
    vec4 el = unpackEdges(l), er = unpackEdges(r), et = unpackEdges(t), eb = unpackEdges(b);
    vec4 e = unpackEdges(c) * vec4(el.y, er.x, et.w, eb.z);
    e = clamp(e + clamp(kLeakFrom - dot(e, vec4(1.0)), 0.0, 1.0) / kLeakFrom * kLeak, 0.0, 1.0);
    // diagonals, around either corner: top left, top right, bottom left, bottom right
    vec4 d = kDiagonal * vec4(e.x * el.z + e.z * et.x, e.z * et.y + e.y * er.z, e.w * eb.x + e.x * el.w, e.y * er.w + e.w * eb.y);
    vec4 straight = vec4(visibilityOf(l), visibilityOf(r), visibilityOf(t), visibilityOf(b));
    vec4 across = vec4(visibilityOf(imageLoad(noisy, low).x), visibilityOf(imageLoad(noisy, ivec2(high.x, low.y)).x),
                       visibilityOf(imageLoad(noisy, ivec2(low.x, high.y)).x), visibilityOf(imageLoad(noisy, high).x));
    float value = (constants.centre * visibilityOf(c) + dot(e, straight) + dot(d, across)) / (constants.centre + dot(e + d, vec4(1.0)));
    if (kLast) imageStore(visibility, p, vec4(clamp(value, 0.0, 1.0)));
    else imageStore(intermediate, p, uvec4(packNoisy(value, c >> 16)));
}
