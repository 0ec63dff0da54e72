// Push constants of hybrid.
#ifndef OBSCURA_HYBRID_CONSTANTS_H
#define OBSCURA_HYBRID_CONSTANTS_H
#include "shared/falloff.h"
OBSCURA_SHARED_BEGIN

struct HybridTrace {  // trace.comp
    ivec2 size;            // of the map, px
    FalloffBlock falloff;
    uint rays;
    uint steps;            // most steps of a ray; that many if they are equal
    uint scale;            // image pixels per map pixel, each way
    float cone;            // cosine of the cone's half angle
    float offset;          // of rays' origin along the normal, cells
    float jitter;          // 1: steps are shifted for each ray; 0: half a step
    float grain;           // least side of a noise cell, image pixels
    uint side;             // of the interleaving tile, map pixels; 1: not interleaved
    float stride;          // longest step, cells of its level
    uint octave;           // log2 of the number of steps an octave
    uint equal;            // 1: equal steps in one level
};
OBSCURA_SHARED_SIZE(HybridTrace, 64);

OBSCURA_SHARED_END
#endif
