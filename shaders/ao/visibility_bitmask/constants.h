// Push constants of visibility_bitmask.
#ifndef OBSCURA_VISIBILITY_BITMASK_CONSTANTS_H
#define OBSCURA_VISIBILITY_BITMASK_CONSTANTS_H
#include "shared/falloff.h"
OBSCURA_SHARED_BEGIN

struct VisibilityBitmaskSectors {  // sectors.comp
    FalloffBlock falloff;
    uint slices;
    uint steps;            // a side
    float thickness;       // metres
    float mipOffset;       // log2 of px up to which level 0 is read
    uint rayAxis;          // slices are evenly spaced 0: on the screen, 1: around the view ray
};
OBSCURA_SHARED_SIZE(VisibilityBitmaskSectors, 32);

OBSCURA_SHARED_END
#endif
