// Joint bilateral upsampling along the rows, from a map to every pixel of every `scale`th row. See runtime/ao/upsample.h.
// In: the map and its receivers, linear depth, packed normals. Out: visibility, full width, the map's height.
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
layout(set = 0, binding = 4, rg32ui) uniform readonly uimage2D receivers;
layout(set = 0, binding = 5, r16f) uniform writeonly image2D result;
layout(push_constant) uniform Block { Upsample constants; };

void main() {
    View view = viewBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (p.x >= int(view.visible.x) || p.y >= constants.size.y) return;
    int every = constants.scale;
    ivec2 own = min(p * ivec2(1, every), ivec2(view.visible) - 1) + ivec2(view.guard);
    float z = imageLoad(depth, own).x;
    if (isSky(view, z)) {
        imageStore(result, p, vec4(1.0));
        return;
    }
    vec3 here = eyePosition(view, vec2(own) + 0.5, z);
    vec3 n = unpackNormal(imageLoad(normals, own).x);
    float inverseWindow = 1.0 / constants.window, inverseRange = 1.0 / constants.range, middle = 0.5 * float(every);

    int count = constants.size.x, reach = int(0.5 * constants.window);
    float nearest = imageLoad(source, ivec2(min(p.x / every, count - 1), p.y)).x;
    int from = max((p.x - reach) / every, 0), to = min((p.x + reach) / every, count - 1);
    float sum = 0.0, weight = 0.0;
    for (int j = from; j <= to; ++j) {
        float value = imageLoad(source, ivec2(j, p.y)).x;
        uvec2 receiver = imageLoad(receivers, ivec2(j, p.y)).xy;
        float zq = uintBitsToFloat(receiver.x);
        vec2 at = vec2(ivec2(j, p.y) * every + ivec2(view.guard)) + middle;
        vec3 d = eyePosition(view, at, zq) - here;
        float w = bilateral(
            abs(at.x - float(own.x) - 0.5) * inverseWindow, dot(n, unpackNormal(receiver.y)), length(d) * inverseRange, value - nearest);
        w = isSky(view, zq) ? 0.0 : w;
        sum += w * value;
        weight += w;
    }
    imageStore(result, p, vec4(weight > 0.0 ? sum / weight : nearest));
}
