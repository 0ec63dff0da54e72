// Obscurance from the nearest texels of one level [Hoang and Low 2012, eq. 5-7]: the mean over samples q of rho(|q-p|) times the cosine
// between the normal and q-p. Samples below the surface or out of reach count as open; none is rejected.
// Directed, a sample has the squared cosine as weight, the fraction of a direction's hemisphere below its elevation [Dimitrov,
// Horizon-Split Ambient Occlusion, eq. 6]: one cosine is the weight, the other is in the vector to the sample.
// In: depth and packed normals of a level. The includer writes the result for an area of the level.
#ifndef OBSCURA_MULTI_RESOLUTION_SAMPLE_GLSL
#define OBSCURA_MULTI_RESOLUTION_SAMPLE_GLSL
#include "ao/multi_resolution/constants.h"
#include "ao/multi_resolution/levels.glsl"
#include "shared/falloff.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(push_constant) uniform Block { MultiResolutionSample constants; };

// Poisson disk with the symmetries of a square, so that a mirrored picture has the mirrored samples. At the paper's radius of 5 all are at
// texel centres, at least 2 texels apart; opposite pairs cancel on a plane.
const vec2 kDisk[16] = vec2[](vec2(0.2, 0.2), vec2(-0.2, -0.2), vec2(-0.2, 0.2), vec2(0.2, -0.2),
                              vec2(0.6, 0.0), vec2(-0.6, 0.0), vec2(0.0, 0.6), vec2(0.0, -0.6),
                              vec2(0.8, 0.4), vec2(-0.8, -0.4), vec2(-0.4, 0.8), vec2(0.4, -0.8),
                              vec2(0.8, -0.4), vec2(-0.8, 0.4), vec2(0.4, 0.8), vec2(-0.4, -0.8));

struct Place {
    Surface surface;
    vec2 ray, step;    // eye-space xy at depth 1: of the texel, and per texel
    vec2 scale;        // scale of xy = depth * x + y: (1, 0), orthographic (0, 1)
    ivec2 at;
};

void tap(Place p, FalloffBlock rho, ivec2 last, ivec2 offset, inout vec3 sum, inout float count) {
    ivec2 at = p.at + offset, q = clamp(at, ivec2(0), last);
    float z = imageLoad(depth, q).x;
    vec3 v = vec3((p.ray + vec2(offset) * p.step) * (z * p.scale.x + p.scale.y), -z) - p.surface.position;
    float square = dot(v, v), inverse = inversesqrt(max(square, 1e-20));
    bool inside = at == q;
    float cosine = max(dot(p.surface.n, v) * inverse, 0.0), w = inside ? cosine * falloff(rho, square * inverse) : 0.0;
    sum += kDirected ? w * inverse * v : vec3(w, 0, 0);
    count += inside ? 1.0 : 0.0;
}

// Sum over every `shares`th sample from `share` on. p: a pixel of the area. Out: the number of samples, the pixel's normal.
vec3 sampled(ivec2 p, int share, int shares, out float count, out vec3 n) {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    FalloffBlock rho = constants.falloff;
    ivec2 last = constants.size - 1;
    Place place;
    place.at = constants.origin + p;
    float z = imageLoad(depth, place.at).x;
    place.scale = view.orthographic > 0.5 ? vec2(0, 1) : vec2(1, 0);
    place.step = constants.texel * view.unproject.xy;
    place.ray = (vec2(place.at) + 0.5) * place.step + view.unproject.zw;
    place.surface = surfaceOf(view, (vec2(place.at) + 0.5) * constants.texel, z, imageLoad(normals, place.at).x);

    float radius = min(constants.reach * rho.reach * view.pixelsPerMetre /
                           ((z * place.scale.x + place.scale.y) * constants.texel), constants.maxRadius);
    bool none = radius < 1.0 || isSky(view, z);
    vec3 sum = vec3(0.0);
    count = 0.0;
    vec2 shape = vec2(constants.columns, 1.0);
    if (constants.disk != 0u) {
        int points = none ? 0 : 16;
        if (shares > 1) {
            for (int i = share; i < points; i += shares) tap(place, rho, last, ivec2(round(kDisk[i] * radius * shape)), sum, count);
        } else {
            for (int i = 0; i < points; i += 2) {
                tap(place, rho, last, ivec2(round(kDisk[i] * radius * shape)), sum, count);
                tap(place, rho, last, ivec2(round(kDisk[i + 1] * radius * shape)), sum, count);
            }
        }
        // At small radii the innermost points, the first four, are the pixel itself.
        count -= !none && radius <= constants.ownRadius ? (shares > 1 ? float(share < 4) : 4.0) : 0.0;
    } else {
        // An even number of texels, symmetric about the pixel, which is not among them: -5, -3, -1, 1, 3 and 5 times `spread`.
        int across = none ? 0 : radius < 3.0 ? 2 : radius < 5.0 ? 4 : 6;
        float end = float(across), spread = radius / (end - 1.0);
        if (shares > 1) {
            for (int i = share; i < across * across; i += shares)
                tap(place, rho, last, ivec2(round((2.0 * vec2(i % across, i / across) + 1.0 - end) * spread * shape)), sum, count);
        } else {
            for (float y = 1.0 - end; y < end; y += 2.0)
                for (float x = 1.0 - end; x < end; x += 2.0) tap(place, rho, last, ivec2(round(vec2(x, y) * spread * shape)), sum, count);
        }
    }
    n = place.surface.n;
    return sum * constants.gain;
}

#endif
