// Layout of scans and push constants, for C++ and GLSL: K directions on the screen, each with a grid of parallel lines cut into intervals
// of B0 px. The grid is centred on the image and common to all lines, so that intervals of neighbouring lines are adjacent, and direction k
// + K/2 is direction k in reverse order.
#ifndef OBSCURA_FAR_FIELD_CONSTANTS_H
#define OBSCURA_FAR_FIELD_CONSTANTS_H
#include "ao/common/constants.h"
OBSCURA_SHARED_BEGIN

struct Direction {
    vec2 along;        // on the screen, unit, y down
    vec2 origin;       // px from the grid's first interval and first line to the image centre
    uint lines;        // a multiple of 2^(levels - 1)
    uint intervals;    // a multiple of 2^(levels - 1)
    uint base;         // first cell of this direction; each batch begins at 0
    uint total;        // cells of all levels: level n begins at total - (total >> n shift), see levelBase()
    float from;        // along the direction on the image plane at depth 1 m: the image centre, metres
    float step;        // and one pixel, metres
    float slope;       // s, of the second receiver angle; see kFlattest
    float perRise;     // pixels at depth 1 m per metre of m0 - m1
};
OBSCURA_SHARED_SIZE(Direction, 48);

// A receiver angle steeper than a view ray is flat would see the farther of two points on that ray above the nearer. So |s| is at most this
// fraction of 1 / |x| at the image's edges at depth 1 m.
const float kFlattest = 0.9f;
const uint kCellsWide = 4096u;  // texels per row of the image of all cells; supported by every device

const uint kNearPart = 1u, kFarPart = 2u;
struct FarFieldConstants {
    uint directions;     // K
    uint first, count;   // batch whose cells are in memory: directions first ... first + count - 1 and, if paired, their opposites
    uint stride;         // every stride-th direction is evaluated
    uint segments;       // of each sector
    uint levels;         // of the pyramid of intervals
    float interval;      // B0, px
    float perInterval;   // 256 / B0
    float lineStep;      // px from line to line
    float connection;    // weight of the line to the previous point: 0 slab, 1 connection
    float unit;          // metres: the falloff's length; depths are kept as unit / depth
    uint taps;           // samples of the near field in each segment; 0: no near field
    uint parts;          // fields that count: kNearPart, kFarPart. Without kNearPart the near field still raises the horizon
    uint paired;         // 1: one scan serves two opposite directions
    float thickness;     // of surfaces, metres; 0: endless
    float jitter;        // of directions, fraction of a segment
    uint side;           // of the interleaving tile, px
    float longest;       // longest interval, fraction of its distance from the receiver
    uint alternate;      // 1: directions of every other pixel are turned by half a segment, of the evaluated directions' width
};
OBSCURA_SHARED_SIZE(FarFieldConstants, 76);

struct FarFieldPyramid {  // pyramid.comp
    FarFieldConstants constants;
    uint from;  // level from which the next three are made
};
OBSCURA_SHARED_SIZE(FarFieldPyramid, 80);
struct FarFieldFields {  // fields.comp
    PackLayers layers;
    float unit;  // metres: the falloff's length
};
OBSCURA_SHARED_SIZE(FarFieldFields, 12);
struct FarFieldObjectPyramid {  // objects_pyramid.comp
    uint first;  // direction
    uint level;
};
OBSCURA_SHARED_SIZE(FarFieldObjectPyramid, 8);
struct FarFieldBoxAverage {  // box_average.comp
    uint side;  // of the interleaving tile, px
};
OBSCURA_SHARED_SIZE(FarFieldBoxAverage, 4);
struct FarFieldBlur {  // blur.comp
    float threshold;  // least difference of visibility between surfaces that are not averaged
};
OBSCURA_SHARED_SIZE(FarFieldBlur, 4);

OBSCURA_SHARED_END
#endif
