// Push constants of the off-screen pass.
#ifndef OBSCURA_OFFSCREEN_CONSTANTS_H
#define OBSCURA_OFFSCREEN_CONSTANTS_H
#include "shared/falloff.h"
OBSCURA_SHARED_BEGIN

struct OffscreenTrace {  // trace.comp
    ivec2 size;            // of the map, px
    FalloffBlock falloff;
    uint rays;
    float stride;          // longest ray step, cells of its level
    uint scale;            // image pixels per map pixel, each way
    uint hidden;           // 1: occluders inside the image behind visible surfaces count too
    float offset;          // of rays' origin along the normal, cells
    float grain;           // least side of a noise cell, image pixels
    float reach;           // of Blocking: metres from the receiver
    float thickness;       // of Blocking: metres behind the visible surface
    uint octave;           // log2 of the number of steps an octave
    uint steps;            // most steps of a ray
    uint unused;
};
OBSCURA_SHARED_SIZE(OffscreenTrace, 64);

OBSCURA_SHARED_END
#endif
