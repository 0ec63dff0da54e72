// Hybrid obscurance, first pass [Reinbothe 2009, eq. 4]: a cone of rays through the volume, one invocation per map pixel.
// In: volume, linear depth, packed normals. Out: visibility, depth and normal of the map's receivers; with BENT also raw bent normals.
// Formulas: runtime/ao/methods/hybrid/hybrid.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant VOLUME_NANOVDB
#pragma variant BENT
#pragma variant VOLUME_NANOVDB,BENT
#define VOLUME_BINDING 2
#include "ao/common/map.glsl"
#include "ao/common/tile.glsl"
#include "ao/common/volume_rays.glsl"
#include "ao/hybrid/constants.h"
#include "shared/falloff.h"
#ifdef BENT
#include "ao/common/bent_normals.glsl"
layout(set = 0, binding = 7, rg32ui) uniform writeonly uimage2D bentNormals;
#endif
layout(push_constant) uniform Block { HybridTrace constants; };

const float kTwoPi = 6.28318531, kGolden = -2.39996323, kShift = 0.754877666;

void main() {
    View view = viewBlock;
    Volume volume = volumeBlock;
    FalloffBlock rho = constants.falloff;
    openVolume();
    uint rayCount = constants.rays, stepCount = constants.steps;
    float coneCosine = constants.cone, jitterOfSteps = constants.jitter;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, constants.size))) return;
    vec3 here, n;
    if (!receive(view, p, int(constants.scale), here, n)) {
#ifdef BENT
        imageStore(bentNormals, p, rawBent(view.skyDepth, vec3(0.0)));
#endif
        return;
    }

    // From here on all positions are in cells, so that a step is one vector addition.
    vec3 normal = cellsAlong(volume, n) * volume.centre.w, receiver = cellOf(volume, here);
    VolumeRays rays = volumeRays(volume, receiver, normal, rho.reach, constants.offset, constants.stride, constants.octave,
        constants.equal * constants.steps);
    // Noise depends on the place in the world, not on the pixel, so it does not move with the camera.
    uint grain = latticeSize(view, volume, rays.level, here, constants.grain);
    vec3 xi = fract(cellNoise(latticeCell(volume, receiver, normal, grain)) + frameShift(view));
    vec3 tangent, bitangent;
    basisAround(normal, tangent, bitangent);

    // The azimuth advances by the golden angle from ray to ray. Interleaved, a pixel has every `shares`th ray.
    uint shares = constants.side * constants.side, share = constants.side > 1u ? shareOf(view, p, constants.side) : 0u;
    float azimuth = kTwoPi * xi.y + kGolden * float(share);
    vec2 azimuthVector = vec2(cos(azimuth), sin(azimuth));
    vec2 rotation = constants.side > 1u ? vec2(cos(kGolden * float(shares)), sin(kGolden * float(shares)))
                                        : vec2(-0.737368878, -0.675490294);
    // An origin in a set cell is next to another surface. Which half of the rays it blocks is unknown, so each ray is half blocked at the
    // origin, and is traced from one cell on.
    bool outside = hitWeight(volume, receiver) == 0.0;
    bool originOccupied = !outside && occupiedAt(volume, rays.receiver + rays.lift, rays.level);
    float originBlocked = originOccupied ? 0.5 : 0.0, lift = constants.offset * rays.metres;
#ifdef BENT
    vec3 bentBlocked = vec3(0.0), bentWhole = vec3(0.0);  // cell axes
    float weights = 0.0;
#endif
    float blocked = 0.0, total = 0.0, shift = fract(xi.z + kShift * float(share)), shiftStep = kShift * float(shares);
    for (uint i = share; i < rayCount; i += shares) {
        float c = mix(coneCosine, 1.0, (float(i) + xi.x) / float(rayCount));
        float sine = sqrt(max(1.0 - c * c, 0.0));
        vec3 ray = tangent * (azimuthVector.x * sine) + bitangent * (azimuthVector.y * sine) + normal * c;
        float first = mix(0.5, shift, jitterOfSteps), nearest = originOccupied ? 1.0 : 0.0;
        if (outside) nearest = entryOf(volume, rays, ray);
        // Back to front: the last hit is the nearest.
        uint hit = rays.count;
        for (uint k = 1u; k <= stepCount; ++k) {
            uint j = stepCount - k;
            VolumeStep step = stepOf(rays, j, first);
            if (j < rays.count) hit = occupiedAt(volume, placeOf(rays, step, ray), step.level) && step.t >= nearest ? j : hit;
        }
        // Distance from the receiver, not from the raised origin, as to a surface that faces the ray.
        VolumeStep step = stepOf(rays, hit, first);
        float far = hit < rays.count
            ? hitWeight(volume, placeInWorld(rays, step, ray)) * falloff(rho, (step.t + constants.offset * c * step.grow) * rays.metres)
            : 0.0;
        blocked += c * mix(far, falloff(rho, lift * c), originBlocked);
        total += c;
#ifdef BENT
        bentBlocked += c * mix(far, falloff(rho, lift * c), originBlocked) * ray;
        bentWhole += c * ray;
        weights += c;
#endif
        azimuthVector =
            vec2(azimuthVector.x * rotation.x - azimuthVector.y * rotation.y, azimuthVector.x * rotation.y + azimuthVector.y * rotation.x);
        shift = fract(shift + shiftStep);
    }
    // Shares have different sums of cosines: dividing by their mean makes the shares average to the whole. A single share's visibility
    // may be below 0.
    if (constants.side > 1u) total = float(rayCount / shares) * mix(coneCosine, 1.0, (0.5 * float(rayCount - 1u) + xi.x) / float(rayCount));
#ifdef BENT
    vec3 bent = blockedBent(eyeAlong(volume, bentBlocked) / weights, eyeAlong(volume, bentWhole) / weights, n, 1.0 - blocked / weights);
    imageStore(bentNormals, p, rawBent(-here.z, bent));
#endif
    imageStore(map, p, vec4(min(1.0 - blocked / total, 1.0)));
}
