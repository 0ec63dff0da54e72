// Lighting of the visible part. In: linear depth, G-buffer, visibility, shadow map. Out: radiance, linear; the guard band is not written.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant BENT
#include "scene/shade.glsl"
#include "shared/octahedral.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform Light { LightingBlock light; };
layout(set = 0, binding = 1) uniform sampler2D depthMap;       // linear, metres
layout(set = 0, binding = 2) uniform usampler2D geometricMap;
layout(set = 0, binding = 3) uniform usampler2D shadedMap;
layout(set = 0, binding = 4) uniform sampler2D baseColorMap;
layout(set = 0, binding = 5) uniform sampler2D materialMap;
layout(set = 0, binding = 6) uniform sampler2D emissionMap;
layout(set = 0, binding = 7) uniform sampler2D visibilityMap;  // visible size
layout(set = 0, binding = 8) uniform sampler2D shadowMap;
layout(set = 0, binding = 9) uniform sampler2DShadow shadowCompared;  // the same image
layout(set = 0, binding = 10, rgba16f) writeonly uniform image2D lit;
#ifdef BENT
layout(set = 0, binding = 11) uniform sampler2D bentMap;  // visible size
#endif

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(light.view.visible)))) return;
    ivec2 p = at + ivec2(light.view.guard);

    float depth = texelFetch(depthMap, p, 0).x;
    vec2 centre = vec2(p) + 0.5;
    if (isSky(light.view, depth)) {
        vec3 direction = light.view.orthographic > 0.5 ? vec3(0.0, 0.0, -1.0) : normalize(eyePosition(light.view, centre, 1.0));
        imageStore(lit, p, vec4(skyRadiance(light, direction), 1.0));
        return;
    }
    vec4 color = texelFetch(baseColorMap, p, 0);
    vec4 material = texelFetch(materialMap, p, 0);
    vec3 emission = texelFetch(emissionMap, p, 0).rgb;
    if (material.z > 0.5) {
        imageStore(lit, p, vec4(color.rgb + emission, 1.0));
        return;
    }
    Surface s;
    s.position = eyePosition(light.view, centre, depth);
    s.geometric = unpackNormal(texelFetch(geometricMap, p, 0).x);
    s.normal = unpackNormal(texelFetch(shadedMap, p, 0).x);
    s.baseColor = color.rgb;
    s.roughness = material.x;
    s.metalness = material.y;
    s.visibility = texelFetch(visibilityMap, at, 0).x * color.a;
#ifdef BENT
    // The bend belongs to the geometric normal; a normal map turns the bent normal by as much as the normal.
    s.ambient = normalize(texelFetch(bentMap, at, 0).xyz + s.normal - s.geometric);
#endif
    float sun = sunlight(light, shadowMap, shadowCompared, s.position, s.geometric);
    imageStore(lit, p, vec4(shade(light, s, sun) + emission, 1.0));
}
