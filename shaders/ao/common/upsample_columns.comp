// Joint bilateral upsampling along the columns, from every `scale`th row to all of them. See runtime/ao/upsample.h.
// In: visibility of those rows, linear depth, packed normals, `other`. Out: visibility, visible size.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#include "shared/octahedral.glsl"
#include "shared/view.h"
#include "upsample.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, r16f) uniform readonly image2D source;
layout(set = 0, binding = 4, r16f) uniform readonly image2D other;
layout(set = 0, binding = 5, r16f) uniform writeonly image2D result;
layout(push_constant) uniform Block { Upsample constants; };
layout(constant_id = 0) const uint joins = 0;  // 1: the obscurance is subtracted from `other`, visible size

void main() {
    View view = viewBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    int every = constants.scale;
    ivec2 guard = ivec2(view.guard), last = ivec2(view.visible) - 1 + guard, own = p + guard;
    float z = imageLoad(depth, own).x;
    if (isSky(view, z)) {
        imageStore(result, p, joins != 0u ? imageLoad(other, p) : vec4(1.0));
        return;
    }
    vec3 here = eyePosition(view, vec2(own) + 0.5, z);
    vec3 n = unpackNormal(imageLoad(normals, own).x);
    float inverseWindow = 1.0 / constants.window, inverseRange = 1.0 / constants.range;

    int count = constants.size.y, reach = int(0.5 * constants.window);
    float nearest = imageLoad(source, ivec2(p.x, min(p.y / every, count - 1))).x;
    int from = max((p.y - reach) / every, 0), to = min((p.y + reach) / every, count - 1);
    float sum = 0.0, weight = 0.0;
    for (int j = from; j <= to; ++j) {
        float value = imageLoad(source, ivec2(p.x, j)).x;
        ivec2 q = min(ivec2(own.x, j * every + guard.y), last);
        float zq = imageLoad(depth, q).x;
        vec3 d = eyePosition(view, vec2(q) + 0.5, zq) - here;
        float facing = dot(n, unpackNormal(imageLoad(normals, q).x));
        float w = bilateral(abs(float(q.y - own.y)) * inverseWindow, facing, length(d) * inverseRange, value - nearest);
        w = isSky(view, zq) ? 0.0 : w;
        sum += w * value;
        weight += w;
    }
    float value = weight > 0.0 ? sum / weight : nearest;
    imageStore(result, p, vec4(joins != 0u ? max(imageLoad(other, p).x - (1.0 - value), 0.0) : value));
}
