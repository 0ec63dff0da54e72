// Push constants of shaders/voxel/rasterise.comp: one primitive.
#ifndef OBSCURA_VOXEL_JOB_H
#define OBSCURA_VOXEL_JOB_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct VoxelJob {
    vec4 rows[3];      // object space -> cells of a level, counted from its window's lowest corner; cell i spans [i, i + 1]
    uvec4 corner;      // xyz: that corner's cell in the world, modulo the side; w: cells a side, a power of two
    uint triangles;
    uint indices;      // first index
    uint positions;    // first float of vertex 0, in the vertices or, if posed, in the posed positions
    uint posed;        // 1 or 0
    uint thin;         // 1: thin shell, 0: conservative
    uint firstWord;    // of the level
    uint unused[2];
};
OBSCURA_SHARED_SIZE(VoxelJob, 96);

OBSCURA_SHARED_END
#endif
