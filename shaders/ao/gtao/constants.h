// Push constants of gtao.
#ifndef OBSCURA_GTAO_CONSTANTS_H
#define OBSCURA_GTAO_CONSTANTS_H
#include "shared/falloff.h"
OBSCURA_SHARED_BEGIN

struct GtaoHorizons {  // horizons.comp
    FalloffBlock falloff;
    uint slices;
    uint steps;            // a side
    float mipOffset;       // log2 of px up to which level 0 is read
    float power;           // exponent on visibility
    float least;           // lowest visibility
    uint rayAxis;          // slices are evenly spaced 0: on the screen, 1: around the view ray
};
OBSCURA_SHARED_SIZE(GtaoHorizons, 36);

OBSCURA_SHARED_END
#endif
