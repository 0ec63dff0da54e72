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

// Taps of a disk of radius 1: Vogel's spiral, equal areas.
const int kTaps = 8;
const vec2 kDisk[kTaps] = vec2[kTaps](
    vec2(0.250, 0.000), vec2(-0.319, 0.292), vec2(0.049, -0.557), vec2(0.402, 0.525), vec2(-0.739, -0.131), vec2(0.700, -0.445),
    vec2(-0.234, 0.870), vec2(-0.446, -0.859));
const float kWidest = 6.0;  // texels: largest radius of the penumbra's filter
const float kSharp = 1.5;   // texels: below it 3x3 texels are filtered

// Visibility of the sun's disk, 0 to 1 [Fernando 2005, Percentage-Closer Soft Shadows]: the radius of the filter is that of the penumbra at
// the mean distance of what is in front. `map`: nearest texels; `compared`: the same image, compared and filtered.
float sunlight(LightingBlock light, sampler2D map, sampler2DShadow compared, vec3 position, vec3 geometric) {
    float facing = dot(geometric, light.toSun.xyz), side = light.toSun.w, size = light.up.w;
    if (facing <= 0.0) return 0.0;
    // Offset along the normal against self-shadowing: the depth range of a texel at this slope.
    float slope = sqrt(max(1.0 - facing * facing, 0.0));
    vec3 lifted = position + geometric * (side * (0.35 + 1.65 * slope));
    vec3 s = (light.shadowFromEye * vec4(lifted, 1.0)).xyz;
    if (any(lessThan(s.xy, vec2(0.0))) || any(greaterThan(s.xy, vec2(1.0)))) return 1.0;
    float reference = clamp(s.z, 0.0, 1.0);
    // Depth of the surface's plane, per texel [Isidoro 2006, Shadow Mapping: GPU-based Tips and Techniques].
    vec2 across = (mat3(light.shadowFromEye) * geometric).xy * (side * size);
    vec2 plane = across * (-side / (max(facing, 0.2) * light.shadow.x));

    // 4x4 texels: columns and rows at -1 to 2 from `base`. A gather returns (0,1) (1,1) (1,0) (0,0).
    vec2 texel = s.xy * size - 0.5, base = floor(texel), f = texel - base;
    vec4 x = vec4(-1.0, 0.0, 1.0, 2.0) - f.x, y = vec4(-1.0, 0.0, 1.0, 2.0) - f.y;
    float sum = 0.0, above = 0.0, blockers = 0.0;
    for (int i = 0; i < 4; ++i) {
        bvec2 second = bvec2(i & 1, i >> 1);
        vec2 columns = second.x ? x.zw : x.xy, rows = second.y ? y.zw : y.xy;
        vec4 there = vec4(columns.xyyx * plane.x + rows.yyxx * plane.y) + reference;
        vec4 depth = textureGather(map, (base + vec2(second) * 2.0) / size);
        vec4 isLit = vec4(greaterThanEqual(there, depth));
        vec2 wx = second.x ? vec2(1.0, f.x) : vec2(1.0 - f.x, 1.0), wy = second.y ? vec2(1.0, f.y) : vec2(1.0 - f.y, 1.0);
        sum += dot(isLit, wx.xyyx * wy.yyxx);
        above += dot(1.0 - isLit, depth - there);
        blockers += dot(1.0 - isLit, vec4(1.0));
    }
    // And 2x2 texels at four places around.
    vec2 ring = vec2(0.9, 0.4) * (0.7 * kWidest);
    for (int i = 0; i < 4; ++i) {
        float there = reference + dot(plane, ring) + abs(plane.x) + abs(plane.y);
        vec4 depth = textureGather(map, s.xy + ring / size), isBlocker = vec4(greaterThan(depth, vec4(there)));
        above += dot(isBlocker, depth - there);
        blockers += dot(isBlocker, vec4(1.0));
        ring = vec2(-ring.y, ring.x);
    }
    if (blockers == 0.0 || blockers == 32.0) return 1.0 - blockers / 32.0;
    float radius = 0.5 * light.shadow.y * light.shadow.x * above / (blockers * side);
    float sharp = sum / 9.0;
    if (radius <= kSharp) return sharp;
    float soft = 0.0, wide = min(radius, kWidest);
    for (int i = 0; i < kTaps; ++i) {
        vec2 off = wide * kDisk[i];
        soft += textureLod(compared, vec3(s.xy + off / size, reference + dot(plane, off)), 0.0);
    }
    return mix(sharp, soft / float(kTaps), min(radius - kSharp, 1.0));
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
