// Push constants of shaders/voxel/rasterise.comp: one primitive.
#ifndef OBSCURA_VOXEL_JOB_H
#define OBSCURA_VOXEL_JOB_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct VoxelJob {
    vec4 rows[3];      // object space -> cells, counted from the window's lowest corner; cell i spans [i, i + 1]
    uvec4 shift;       // as in shared/volume.h
    uint triangles;
    uint indices;      // first index
    uint positions;    // first float of vertex 0, in the vertices or, if posed, in the posed positions
    uint posed;        // 1 or 0
    uint thin;         // 1: thin shell, 0: conservative
    uint unused[3];
};
OBSCURA_SHARED_SIZE(VoxelJob, 96);

OBSCURA_SHARED_END
#endif
