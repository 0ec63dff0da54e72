// Push constants of horizon_split.
#ifndef OBSCURA_HORIZON_SPLIT_CONSTANTS_H
#define OBSCURA_HORIZON_SPLIT_CONSTANTS_H
#include "shared/falloff.h"
OBSCURA_SHARED_BEGIN

struct HorizonSplitMarch {  // horizons.comp and normal_rays*.comp
    FalloffBlock falloff;
    uint directions;         // N_d
    uint steps;              // N_s
    uint rays;               // N_n, per direction; 0: horizons are not stored
    float radius;            // R, metres
    float spacing;           // of steps: 0 even, as in the paper; 1 quadratic, denser near the pixel
    float jitter;            // of steps, 0..1
    float offset;            // of lines from the surface, px
    float horizonThickness;  // of surfaces, for horizons, metres
    float rayThickness;      // of surfaces, for normal rays, metres
    uint side;               // of the interleaving tile, px; 1: not interleaved
};
OBSCURA_SHARED_SIZE(HorizonSplitMarch, 52);

OBSCURA_SHARED_END
#endif
