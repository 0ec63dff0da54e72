// Shading: GGX and Lambert for the sun, a hemisphere light and its reflection for the sky.
#ifndef OBSCURA_SCENE_SHADE_GLSL
#define OBSCURA_SCENE_SHADE_GLSL
#include "scene/lighting.h"

const float kPi = 3.14159265;

struct Surface {
    vec3 position;    // eye space, metres
    vec3 normal;      // shaded
    vec3 geometric;
    vec3 baseColor;
    float roughness;
    float metalness;
    float visibility; // of the ambient light; 1: open
#ifdef BENT
    vec3 ambient;     // the bent normal, from which ambient light is taken
#endif
};

// Radiance of the background in a direction: sky above, ground below, a paler horizon between.
vec3 skyRadiance(LightingBlock light, vec3 direction) {
    float up = dot(direction, light.up.xyz);
    vec3 horizon = light.sky.rgb * vec3(1.08, 1.04, 0.98);
    vec3 above = mix(horizon, light.sky.rgb * vec3(0.36, 0.56, 0.90), sqrt(clamp(up, 0.0, 1.0)) * clamp(up * 4.0, 0.0, 1.0));
    vec3 below = mix(horizon, light.ground.rgb, sqrt(clamp(-up * 1.6, 0.0, 1.0)));
    return up >= 0.0 ? above : below;
}

vec3 hemisphere(LightingBlock light, vec3 normal) {
    return mix(light.ground.rgb, light.sky.rgb, 0.5 + 0.5 * dot(normal, light.up.xyz));
}

// Two 1D fits for the split sum's second term [Karis 2014, Physically Based Shading on Mobile].
vec3 environmentBrdf(vec3 f0, float roughness, float nv) {
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a004 = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
    vec2 ab = vec2(-1.04, 1.04) * a004 + r.zw;
    return f0 * ab.x + ab.y;
}

// [Lagarde and de Rousiers 2014, Moving Frostbite to PBR, 4.10.2]
float specularVisibility(float visibility, float nv, float roughness) {
    return clamp(pow(nv + visibility, exp2(-16.0 * roughness - 1.0)) - 1.0 + visibility, 0.0, 1.0);
}

#ifdef BENT
// Part of the reflection's cone that is in the cone of unblocked directions around the bent normal [Jimenez 2016, Practical Real-Time
// Strategies for Accurate Indirect Occlusion, sec. 5: half angles of cosines sqrt(1 - V) and 10^-(roughness^2)]. The cones are caps of the
// sphere, whose intersection is interpolated [Oat, Sander 2007, Ambient Aperture Lighting].
float conesVisibility(float visibility, float roughness, vec3 bent, vec3 reflected) {
    float openCosine = sqrt(clamp(1.0 - visibility, 0.0, 1.0)), lobeCosine = min(exp2(-3.32193 * roughness * roughness), 0.9999);
    float open = acos(openCosine), lobe = acos(lobeCosine), between = acos(clamp(dot(bent, reflected), -1.0, 1.0));
    float inside = abs(open - lobe), apart = open + lobe, smaller = 1.0 - max(openCosine, lobeCosine);
    float both = smoothstep(0.0, 1.0, 1.0 - clamp((between - inside) / max(apart - inside, 1e-4), 0.0, 1.0));
    return clamp(smaller * both / (1.0 - lobeCosine), 0.0, 1.0);
}
// Relative to an open surface, whose reflection is partly below it at grazing angles.
float specularVisibility(float visibility, float roughness, vec3 bent, vec3 normal, vec3 reflected) {
    float open = conesVisibility(1.0, roughness, normal, reflected);
    return min(conesVisibility(visibility, roughness, bent, reflected) / max(open, 1e-3), 1.0);
}
#endif

// GGX with height-correlated Smith [Walter 2007; Heitz 2014] and Schlick's Fresnel, times n.l.
vec3 sunReflection(vec3 n, vec3 v, vec3 l, vec3 diffuse, vec3 f0, float roughness) {
    float nl = max(dot(n, l), 0.0);
    float nv = max(dot(n, v), 1e-4);
    vec3 h = normalize(l + v);
    float nh = clamp(dot(n, h), 0.0, 1.0), vh = clamp(dot(v, h), 0.0, 1.0);
    float a = max(roughness * roughness, 2e-3);
    float a2 = a * a;
    float d = nh * nh * (a2 - 1.0) + 1.0;
    float distribution = a2 / (kPi * d * d);
    float smith = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2) + 1e-6);
    float s = 1.0 - vh;
    float s2 = s * s;
    vec3 fresnel = f0 + (1.0 - f0) * (s2 * s2 * s);
    return (diffuse / kPi * (1.0 - fresnel) + fresnel * (distribution * smith)) * nl;
}

// Visibility of the sun, 0 to 1: a 3x3 filter with bilinear weights, by four gathers.
float sunlight(LightingBlock light, sampler2DShadow shadow, vec3 position, vec3 geometric) {
    float facing = dot(geometric, light.toSun.xyz);
    // Offset along the normal against self-shadowing: the depth range of the filter's width at this slope.
    float slope = sqrt(max(1.0 - facing * facing, 0.0));
    vec3 lifted = position + geometric * (light.toSun.w * (0.35 + 1.65 * slope));
    vec3 s = (light.shadowFromEye * vec4(lifted, 1.0)).xyz;
    if (any(lessThan(s.xy, vec2(0.0))) || any(greaterThan(s.xy, vec2(1.0)))) return 1.0;
    float reference = clamp(s.z, 0.0, 1.0);
    float size = light.up.w;
    vec2 texel = s.xy * size - 0.5;
    vec2 base = floor(texel);
    vec2 f = texel - base;
    vec2 corner = (base + 0.0) / size;  // between texels base-1 and base
    vec4 a = textureGather(shadow, corner, reference);
    vec4 b = textureGather(shadow, corner + vec2(2.0, 0.0) / size, reference);
    vec4 c = textureGather(shadow, corner + vec2(0.0, 2.0) / size, reference);
    vec4 d = textureGather(shadow, corner + vec2(2.0, 2.0) / size, reference);
    // Weights of the columns: (1-f, 1, 1, f). A gather returns (0,1) (1,1) (1,0) (0,0).
    vec4 w = vec4(1.0 - f.x, 1.0, 1.0, f.x);
    float top = dot(w, vec4(a.w, a.z, b.w, b.z)) * (1.0 - f.y) + dot(w, vec4(a.x, a.y, b.x, b.y));
    float bottom = dot(w, vec4(c.w, c.z, d.w, d.z)) + dot(w, vec4(c.x, c.y, d.x, d.y)) * f.y;
    return (top + bottom) / 9.0;
}

vec3 shade(LightingBlock light, Surface s, float sun) {
    vec3 v = towardsEye(light.view, s.position);
    float nv = clamp(dot(s.normal, v), 1e-3, 1.0);
    vec3 f0 = mix(vec3(0.04), s.baseColor, s.metalness);
    vec3 diffuse = s.baseColor * (1.0 - s.metalness);
#ifdef BENT
    vec3 color = diffuse * hemisphere(light, s.ambient) * s.visibility;
#else
    vec3 color = diffuse * hemisphere(light, s.normal) * s.visibility;
#endif
    // With growing roughness the reflection approaches the hemisphere light.
    vec3 r = reflect(-v, s.normal);
    vec3 mirrored = mix(skyRadiance(light, r), hemisphere(light, r), s.roughness * s.roughness);
#ifdef BENT
    float reflects = specularVisibility(s.visibility, s.roughness, s.ambient, s.normal, r);
#else
    float reflects = specularVisibility(s.visibility, nv, s.roughness);
#endif
    color += mirrored * environmentBrdf(f0, s.roughness, nv) * reflects;
    if (sun > 0.0) color += sunReflection(s.normal, v, light.toSun.xyz, diffuse, f0, s.roughness) * light.sun.rgb * sun;
    return color;
}

#endif
