// Normal rays through voxels of the world, which include occluders outside the image and have their true thickness.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant VOLUME_NANOVDB
#pragma variant BENT
#pragma variant VOLUME_NANOVDB,BENT
#define BENT_BINDING 9
#define VOLUME_BINDING 8
#include "ao/common/volume_rays.glsl"
#include "ao/horizon_split/march.glsl"
struct Space {
    Volume volume;
    VolumeRays rays;  // in cells
    bool outside;     // of the volume
};
#include "ao/horizon_split/normal_rays.glsl"
layout(set = 0, binding = 7, std140) uniform VolumeBlock { Volume volumeBlock; };

const float kLift = 2.0;       // cells; the cells that touch a plane end sqrt(3) above it
const float kStride = 1.25;    // longest step, cells; a wall parallel to the grid is one cell thick
const uint kOctave = 3u;

Space spaceOf(View view, Origin origin) {
    Volume volume = volumeBlock;
    openVolume();
    vec3 place = cellOf(volume, origin.position), up = cellsAlong(volume, origin.n) * volume.centre.w;
    return Space(volume, volumeRays(volume, place, up, constants.radius, kLift, kStride, kOctave, 0u), hitWeight(volume, place) == 0.0);
}
vec3 towards(Space space, vec3 d) { return cellsAlong(space.volume, d) * space.volume.centre.w; }

float blockedAt(Space space, vec3 ray, Steps walk, float first) {
    float shift = first / walk.part, entry = space.outside ? entryOf(space.volume, space.rays, ray) : 0.0;
    uint hit = space.rays.count;
    for (uint k = space.rays.count; k-- > 0u;) {  // back to front: the last hit is the nearest
        VolumeStep step = stepOf(space.rays, k, shift);
        hit = occupiedAt(space.volume, placeOf(space.rays, step, ray), step.level) && step.t >= entry ? k : hit;
    }
    VolumeStep step = stepOf(space.rays, hit, shift);
    bool counts = hit < space.rays.count && hitWeight(space.volume, placeInWorld(space.rays, step, ray)) > 0.5;
    return counts ? (step.t + 0.5 * kLift * step.grow) * space.rays.metres : kFree;
}
