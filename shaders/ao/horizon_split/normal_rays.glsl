// Normal rays: occlusion above the horizon [Dimitrov, sec. 3.3]. The rays of a direction have the weight 1 - H^2 of that direction.
// In: linear depth, packed normals, 1 - O_T, H^2 per direction. Out: 1 - O_N, and visibility of both terms.
// With BENT, and BENT_BINDING defined by the includer: adds what rays find blocked to the raw bent normals of what is below the horizon.
// The includer provides the space that rays are traced in: it defines `struct Space` before including this, and
//     Space spaceOf(View view, Origin origin);                          state for a pixel's rays
//     vec3 towards(Space space, vec3 d);                                converts an eye-space direction to that space
//     float blockedAt(Space space, vec3 ray, Steps walk, float first);  distance to the first occluder, metres, or kFree
#ifndef OBSCURA_HORIZON_SPLIT_NORMAL_RAYS_GLSL
#define OBSCURA_HORIZON_SPLIT_NORMAL_RAYS_GLSL
#include "shared/octahedral.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, r16f) uniform readonly image2D belowHorizon;
layout(set = 0, binding = 4, r32ui) uniform readonly uimage2D horizons;
layout(set = 0, binding = 5, r16f) uniform writeonly image2D aboveHorizon;
layout(set = 0, binding = 6, r16f) uniform writeonly image2D visibility;

#ifdef BENT
layout(set = 0, binding = BENT_BINDING, rg32ui) uniform readonly uimage2D bentBelow;
layout(set = 0, binding = BENT_BINDING + 1, rg32ui) uniform writeonly uimage2D bentNormals;
#endif

const float kFree = 3e38;
Space spaceOf(View view, Origin origin);
vec3 towards(Space space, vec3 d);
float blockedAt(Space space, vec3 ray, Steps walk, float first);

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    FalloffBlock rho = constants.falloff;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 texel = p + ivec2(view.guard);
    float z = imageLoad(depth, texel).x;
    if (isSky(view, z)) {
        imageStore(aboveHorizon, p, vec4(1.0));
        imageStore(visibility, p, vec4(1.0));
#ifdef BENT
        imageStore(bentNormals, p, rawBent(z, vec3(0.0)));
#endif
        return;
    }
    Origin origin = originAt(view, texel, z, unpackNormal(imageLoad(normals, texel).x), constants.offset);
    Noise noise = noiseAt(view, p);
    Space space = spaceOf(view, origin);
    vec3 up = towards(space, origin.n);
    Steps walk = stepsOf(constants.steps, constants.radius, constants.spacing, constants.rayThickness);
    Share share = shareOfPixel(view, p, noise, constants.directions, constants.side);
    vec2 direction = share.first;
    uint count = share.count;

#ifdef BENT
    vec3 bent = vec3(0.0), tangents = vec3(0.0);
#endif
    float occlusion = 0.0;
    uint word = 0u;
    for (uint i = 0u; i < count; ++i) {
        if ((i & 3u) == 0u) word = imageLoad(horizons, wordAt(p, i >> 2, view.visible)).x;
        float horizon2 = float(word & 255u) / 255.0;
        word >>= 8u;
        vec3 along = towards(space, direction.x * origin.b + direction.y * origin.c);
        float first = mix(0.5, fract(noise.step + float(i) * kNextStep), constants.jitter) * walk.part;
        float elevation = fract(noise.normal + float(i) * kNextNormal);
        // Equal weights of the part above this direction's horizon [Dimitrov, eq. 8-11, per direction].
        float weight = (1.0 - horizon2) / float(constants.rays);
        for (uint k = 0u; k < constants.rays; ++k) {
            float sine2 = horizon2 + (float(k) + elevation) * weight;
            vec3 ray = sqrt(max(1.0 - sine2, 0.0)) * along + sqrt(sine2) * up;
#ifdef BENT
            float before = occlusion;
#endif
            occlusion += weight * falloff(rho, blockedAt(space, ray, walk, first));
#ifdef BENT
            vec3 t = direction.x * origin.b + direction.y * origin.c;
            bent += (occlusion - before) * (sqrt(max(1.0 - sine2, 0.0)) * t + sqrt(sine2) * origin.n);
#endif
        }
#ifdef BENT
        tangents += direction.x * origin.b + direction.y * origin.c;
#endif
        direction = share.next * direction;
    }
    occlusion /= float(count);
#ifdef BENT
    bent = bent / float(count) + clamp(occlusion, 0.0, 1.0) * missed(tangents, float(count));
    imageStore(bentNormals, p, rawBent(z, unpackBent(imageLoad(bentBelow, p).y) + bent));
#endif
    imageStore(aboveHorizon, p, vec4(clamp(1.0 - occlusion, 0.0, 1.0)));
    imageStore(visibility, p, vec4(clamp(imageLoad(belowHorizon, p).x - occlusion, 0.0, 1.0)));
}

#endif
