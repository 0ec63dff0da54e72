// Material inputs of fragment shaders: descriptor set 1 and texture reads.
#ifndef OBSCURA_SCENE_MATERIAL_GLSL
#define OBSCURA_SCENE_MATERIAL_GLSL
#include "scene/material.h"

layout(set = 1, binding = 0) uniform MaterialUniform { MaterialBlock material; };
layout(set = 1, binding = 1) uniform sampler2D baseColorMap;
layout(set = 1, binding = 2) uniform sampler2D metalRoughMap;
layout(set = 1, binding = 3) uniform sampler2D normalMap;
layout(set = 1, binding = 4) uniform sampler2D emissionMap;
layout(set = 1, binding = 5) uniform sampler2D occlusionMap;

// Bit n: slot n has a texture. A specialization constant, because software rasterizers run both sides of a branch.
layout(constant_id = 1) const uint kMaps = 31u;
bool hasMap(uint slot) { return (kMaps & (1u << slot)) != 0u; }

vec2 mapCoordinates(uint slot, vec4 uv) {
    vec2 c = (material.flags.x & (1u << slot)) != 0u ? uv.zw : uv.xy;
    vec4 m = material.uvMatrix[slot];
    return c.x * m.xy + c.y * m.zw + material.uvOffset[slot].xy;
}

vec4 baseColorOf(vec4 uv, vec4 vertexColor) {
    vec4 color = material.baseColor * vertexColor;
    if (hasMap(0u)) color *= texture(baseColorMap, mapCoordinates(0u, uv));
    return color;
}

// x: metalness, y: roughness
vec2 metalRoughOf(vec4 uv) {
    vec2 f = material.factors.xy;
    if (hasMap(1u)) f *= texture(metalRoughMap, mapCoordinates(1u, uv)).bg;
    return f;
}

// Eye-space unit normal. `side` is -1 on back faces.
vec3 normalOf(vec4 uv, vec3 normal, vec4 tangent, float side) {
    vec3 n = normalize(normal);
    if (hasMap(2u)) {
        vec3 t = tangent.xyz - n * dot(n, tangent.xyz);
        float length2 = dot(t, t);
        if (length2 > 1e-12) {
            t *= inversesqrt(length2);
            vec3 b = cross(n, t) * tangent.w;
            vec3 m = texture(normalMap, mapCoordinates(2u, uv)).xyz * 2.0 - 1.0;
            m.xy *= material.factors.z;
            vec3 mapped = t * m.x + b * m.y + n * m.z;
            float mapped2 = dot(mapped, mapped);
            if (mapped2 > 1e-12) n = mapped * inversesqrt(mapped2);
        }
    }
    return n * side;
}

vec3 emissionOf(vec4 uv) {
    vec3 e = material.emission.rgb;
    if (hasMap(3u)) e *= texture(emissionMap, mapCoordinates(3u, uv)).rgb;
    return e;
}

float occlusionOf(vec4 uv) {
    if (!hasMap(4u)) return 1.0;
    return 1.0 + material.factors.w * (texture(occlusionMap, mapCoordinates(4u, uv)).r - 1.0);
}

#endif
