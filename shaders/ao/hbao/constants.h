// Push constants of hbao.
#ifndef OBSCURA_HBAO_CONSTANTS_H
#define OBSCURA_HBAO_CONSTANTS_H
#include "shared/falloff.h"
OBSCURA_SHARED_BEGIN

struct HbaoHorizons {  // horizons.comp
    FalloffBlock falloff;
    uint directions;
    uint steps;
    float bias;            // radians
    float maxPixels;       // longest reach, px
    float spacing;         // samples lie at mix(t, t^2, spacing) of the reach, t = (i + offset) / steps
    uint viewAxis;         // elevations are measured from 0: the camera's axis, as in the paper; 1: the pixel's view ray
    uint sampleTest;       // 1: a sample counts only if it is above the tangent plane by the bias itself
    uint side;             // of the interleaving tile, px; 1: not interleaved
};
OBSCURA_SHARED_SIZE(HbaoHorizons, 44);

OBSCURA_SHARED_END
#endif
