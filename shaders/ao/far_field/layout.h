// What scans write and receivers read, for C++ and GLSL: K directions on the screen, each with its own grid of parallel lines, cut into
// intervals of B0 px. The grid is centred on the picture and the same for every line, so the intervals of neighbouring lines stand side
// by side, and direction k + K/2 is direction k counted from the other end.
#ifndef OBSCURA_FAR_FIELD_LAYOUT_H
#define OBSCURA_FAR_FIELD_LAYOUT_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct Direction {
    vec2 along;        // on the screen, unit, y down
    vec2 origin;       // px from the grid's first interval and first line to the picture's centre
    uint lines;        // multiples of 2^(levels - 1), as are
    uint intervals;
    uint base;         // where this direction's cells begin
    uint total;        // cells of all levels: level n begins at total - (total >> n shift), see levelBase()
};
OBSCURA_SHARED_SIZE(Direction, 32);

const uint kCellsWide = 4096u;  // texels a row of the image that holds all directions' cells one after the other; every device has as many

const uint kNearPart = 1u, kFarPart = 2u;
struct FarFieldConstants {
    uint directions;     // K
    uint stride;         // every so many-th of them is evaluated
    uint segments;       // of each sector
    uint levels;         // of the pyramid of intervals
    float interval;      // B0, px
    float lineStep;      // px from line to line
    float slope;         // s, of the second receiver angle
    float connection;    // how much of the line below a point leads to the point before it: 0 slab, 1 connection
    float unit;          // metres: the falloff's length; depths are kept as unit / depth
    uint taps;           // of the near field, in each segment; 0 leaves it out
    uint parts;          // what counts: kNearPart, kFarPart; the far field is left out, the near field still raises the horizon
    uint paired;         // 1: one walk serves two opposite directions
    float thickness;     // of surfaces, metres; 0: endless
    float jitter;        // of directions, parts of a sector
    uint side;           // of the interleaving tile
    float longest;       // an interval may be, parts of its distance from the receiver
    uint alternate;      // 1: every other pixel's directions are turned by half a segment
};
OBSCURA_SHARED_SIZE(FarFieldConstants, 68);

OBSCURA_SHARED_END
#endif
