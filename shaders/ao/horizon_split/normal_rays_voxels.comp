// Normal rays through voxels of the world, which include occluders outside the image and have their true thickness.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant VOLUME_NANOVDB
#define VOLUME_BINDING 8
#include "ao/horizon_split/march.glsl"
#include "shared/volume.h"
struct Space {
    Volume volume;
    vec3 start;  // in cells, as rays are
};
#include "ao/horizon_split/normal_rays.glsl"
layout(set = 0, binding = 7, std140) uniform VolumeBlock { Volume volumeBlock; };

const float kLift = 2.0;       // cells; the cells that touch a plane end sqrt(3) above it
const float kStride = 1.25;    // longest step, cells; a wall parallel to the grid is one cell thick
const float kMostSteps = 64.0;

Space spaceOf(View view, Origin origin) {
    Volume volume = volumeBlock;
    openVolume();
    return Space(volume, cellOf(volume, origin.position + kLift * volume.anchor.w * origin.n));
}
vec3 towards(Space space, vec3 d) { return cellsAlong(space.volume, d); }

float blockedAt(Space space, vec3 ray, Steps walk, float first) {
    float steps = clamp(ceil(walk.radius / (kStride * space.volume.anchor.w)), 1.0, kMostSteps), step = walk.radius / steps,
          shift = first / walk.part;
    float result = kFree;
    for (float k = steps - 1.0; k >= 0.0; --k) {  // back to front: the last hit is the nearest
        float l = (k + shift) * step;
        result = occupied(space.volume, space.start + l * ray) ? l + 0.5 * kLift * space.volume.anchor.w : result;
    }
    return result;
}
