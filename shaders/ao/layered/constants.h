// Push constants of layered.
#ifndef OBSCURA_LAYERED_CONSTANTS_H
#define OBSCURA_LAYERED_CONSTANTS_H
#include "shared/falloff.h"
OBSCURA_SHARED_BEGIN

struct LayeredSegments {  // segments.comp
    ivec2 size;            // of the map, px
    FalloffBlock falloff;
    uint slices;           // of this pixel
    uint steps;            // a side
    float maxPixels;       // longest reach, px
    uint side;             // of the interleaving tile, px
    uint map;              // image pixels per invocation, each way
    float assumed;         // thickness of everything with NO_LAYERS, metres
    uint unused;
};
OBSCURA_SHARED_SIZE(LayeredSegments, 48);

struct LayeredGather {  // gather.comp
    ivec2 size;    // of the map, px
    uint map;      // image pixels per share, each way
    uint before;   // shares read before the one at or left of a pixel, each way
    uint taps;     // shares read in all, each way
    float covers;  // radius of the window, in shares: half the tile plus half a share
};
OBSCURA_SHARED_SIZE(LayeredGather, 24);

OBSCURA_SHARED_END
#endif
