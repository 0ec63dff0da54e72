// Push constants of multi_resolution. Positions and sizes are in texels of the level named.
#ifndef OBSCURA_MULTI_RESOLUTION_CONSTANTS_H
#define OBSCURA_MULTI_RESOLUTION_CONSTANTS_H
#include "shared/falloff.h"
OBSCURA_SHARED_BEGIN

struct MultiResolutionDownsample {  // downsample.comp
    ivec2 size;        // of the finer level
    ivec2 coarseSize;  // of the coarser level
    float texel;       // of the finer level, px
    float threshold;   // metres
};
OBSCURA_SHARED_SIZE(MultiResolutionDownsample, 24);

struct MultiResolutionSample {  // sample*.comp
    FalloffBlock falloff;
    ivec2 size;            // of the level
    ivec2 origin;          // of the area with obscurance
    ivec2 area;
    float texel;           // of the level, px
    float reach;           // of samples, relative to the falloff's projected reach
    float maxRadius;       // texels
    float gain;
    uint disk;             // 16 points on a disk instead of every other texel of a square
    uint side;             // of the interleaving tile, px; 1: not interleaved
    float columns;         // of pixels in a length of one row: 1 for square pixels
    float ownRadius;       // texels, up to which the innermost points of the disk are the pixel itself
};
OBSCURA_SHARED_SIZE(MultiResolutionSample, 72);

struct MultiResolutionFilter {  // filter.comp
    ivec2 origin;
    ivec2 area;
    float texel;         // of the level, px
    float perTolerance;  // 1 / metres
    uint planes;         // 1: surfaces differ by distance from the tangent plane; 0: by depth
    uint unused;
};
OBSCURA_SHARED_SIZE(MultiResolutionFilter, 32);

struct MultiResolutionUpsample {  // combine.comp and finish.comp
    ivec2 origin;        // of the level
    ivec2 area;
    ivec2 coarseOrigin;  // of the next coarser level
    ivec2 coarseArea;
    float texel;         // of the level, px
    float perTolerance;  // 1 / metres
    uint planes;         // as in MultiResolutionFilter
    float samples;       // GATHERED: total of a tile's pixels
};
OBSCURA_SHARED_SIZE(MultiResolutionUpsample, 48);

OBSCURA_SHARED_END
#endif
