// What shaders/voxel/rasterise.comp is told of one primitive.
#ifndef OBSCURA_VOXEL_JOB_H
#define OBSCURA_VOXEL_JOB_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct VoxelJob {
    vec4 rows[3];      // object -> cells from the window's lowest corner, each from one whole number to the next
    uvec4 shift;       // as in shared/volume.h
    uint triangles;
    uint indices;      // first index
    uint positions;    // first float of vertex 0, in the vertices or, where posed, in the posed positions
    uint posed;        // 1 or 0
    uint thin;         // 1: the thin shell
    uint unused[3];
};
OBSCURA_SHARED_SIZE(VoxelJob, 96);

OBSCURA_SHARED_END
#endif
