// Reads a pixel's depth layers. Bindings 0 to 4 and the first constant of the passes that include this.
#ifndef OBSCURA_LAYERS_AT_GLSL
#define OBSCURA_LAYERS_AT_GLSL
#include "ao/common/constants.h"
#include "ao/common/packed_layers.glsl"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3) uniform sampler2D thickness;
layout(set = 0, binding = 4) uniform sampler2D second;
layout(constant_id = 0) const uint kLayerCount = 2u;  // 1 or 2

// Length as packed: negative unless solid, at least half a pixel.
float lengthOf(float t, float sheetLength, float leastLength) {
    return t <= 0.0 ? -max(sheetLength, leastLength) : t >= kEndless ? -kEndless : max(t, leastLength);
}

// normal: not normalised.
Layers layersOfPixel(View view, PackLayers packing, ivec2 p, out vec3 normal) {
    float z = imageLoad(depth, p).x;
    bool orthographic = view.orthographic > 0.5;
    float leastLength = 0.5 / view.pixelsPerMetre * (orthographic ? 1.0 : z);
    // A sheet is longer along a grazing ray. The second surface has no normal, so its length is not corrected.
    normal = directionOf(imageLoad(normals, p).x);
    vec3 ray = vec3(orthographic ? vec2(0.0) : (vec2(p) + 0.5) * view.unproject.xy + view.unproject.zw, -1.0);
    float slant = min(sqrt(dot(normal, normal) * dot(ray, ray)) / max(abs(dot(normal, ray)), 1e-6), 20.0);
    float t = texelFetch(thickness, p, 0).x;
    // Along the tangent plane, depth changes by this for every metre across the view, at the depth of the other end.
    float steepest = length(normal.xy) / max(abs(dot(normal, ray)), 1e-6);
    Layers result = Layers(z, lengthOf(t, packing.sheet * slant, leastLength), 0.0, 0.0, min(steepest, 1000.0));
    if (kLayerCount > 1u) {
        ivec2 texel = p >> int(packing.shift);
        vec2 next = texelFetch(second, texel, 0).xy;
        float end = z + (t < kEndless ? t : 1e30);
        if (packing.shift != 0u) {
            // Pixel q, of which the half-size layer is a copy, may see past an edge: if q's first surface is behind this layer, it is the
            // second.
            ivec2 q = texel << 1;
            float zq = imageLoad(depth, q).x;
            next = zq > end ? vec2(isSky(view, zq) ? 0.0 : zq, texelFetch(thickness, q, 0).x) : next;
            next.x = next.x + max(next.y, packing.sheet) > end && next.x > 0.0 ? max(next.x, end) : 0.0;
        }
        if (next.x > z && !isSky(view, z)) {
            result.second = next.x;
            result.secondLength = lengthOf(next.y, packing.sheet, leastLength);
        }
    }
    return result;
}

#endif
