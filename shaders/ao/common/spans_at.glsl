// What depth, normal and depth layers say is solid behind a pixel: bindings 0 to 4 and the first constant of the passes that ask.
#ifndef OBSCURA_SPANS_AT_GLSL
#define OBSCURA_SPANS_AT_GLSL
#include "ao/common/spans.glsl"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3) uniform sampler2D thickness;
layout(set = 0, binding = 4) uniform sampler2D second;
struct Packing {
    float sheet;    // thickness of open sheets, metres
    uint shift;     // 1: the second layer is of half size
};
layout(constant_id = 0) const uint kLayers = 2u;  // that there are, 1 or 2

// As stored: what is no solid is told apart by its sign. All is at least half a pixel thick.
float lengthOf(float t, float sheetThick, float leastThick) {
    return t <= 0.0 ? -max(sheetThick, leastThick) : t >= kEndless ? -kEndless : max(t, leastThick);
}

Spans spansAt(View view, Packing packing, ivec2 p, out uint normal) {
    float z = imageLoad(depth, p).x;
    float leastThick = 0.5 / view.pixelsPerMetre * (view.orthographic > 0.5 ? 1.0 : z);
    // A sheet is longer where the ray grazes it. Of the second surface only the depth is known.
    normal = imageLoad(normals, p).x;
    vec3 position = eyePosition(view, vec2(p) + 0.5, z);
    float slant = 1.0 / max(abs(dot(unpackNormal(normal), towardsEye(view, position))), 0.05);
    float t = texelFetch(thickness, p, 0).x;
    Spans result = Spans(z, lengthOf(t, packing.sheet * slant, leastThick), 0.0, 1.0);
    if (kLayers > 1u) {
        ivec2 chosen = p >> int(packing.shift);
        vec2 found = texelFetch(second, chosen, 0).xy;
        float end = z + (t < kEndless ? t : 1e30);
        if (packing.shift != 0u) {
            // The pixel that was asked sees past an edge what is hidden here: then its own surface comes next.
            ivec2 q = chosen << 1;
            float zq = imageLoad(depth, q).x;
            found = zq > end ? vec2(isSky(view, zq) ? 0.0 : zq, texelFetch(thickness, q, 0).x) : found;
            found.x = found.x + max(found.y, packing.sheet) > end && found.x > 0.0 ? max(found.x, end) : 0.0;
        }
        if (found.x > z && !isSky(view, z)) {
            result.second = found.x;
            result.secondLength = lengthOf(found.y, packing.sheet, leastThick);
        }
    }
    return result;
}

#endif
