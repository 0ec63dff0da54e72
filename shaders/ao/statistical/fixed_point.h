// Fixed point of the frame: units per metre, chosen so that no window's sum exceeds 32 bits.
//
// A window has at most N pixels, the magnitude of a coordinate is at most M, and rounding adds at most one unit, so a sum is at most N (M
// units + 1), which is kept below 2^31. N is the window of the pixel nearest to the camera plus one table texel on each side. Units are a
// power of two, so that small camera movements do not change them.
#ifndef OBSCURA_STATISTICAL_FIXED_POINT_H
#define OBSCURA_STATISTICAL_FIXED_POINT_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct Box {
    float halfWidth;     // of the box, metres
    float height;        // metres, along the normal
    float largest;       // half width on the screen is at most this, px
    uint texelSide;      // of the tables, px
};
OBSCURA_SHARED_SIZE(Box, 16);

OBSCURA_SHARED_END

#ifndef __cplusplus
#include "shared/view.h"

// Over all pixels that are not sky, as bits of floats; all 0 if all are sky.
struct Extent {
    uint nearestInverted;  // ~nearest linear depth
    uint furthest;         // linear depth
    uint coordinate;       // largest magnitude of an eye-space coordinate
    uint unused;
};

float nearestDepth(Extent e) { return uintBitsToFloat(~e.nearestInverted); }

// Half the box's width, px.
float halfWidth(View view, Box box, float depth) { return box.halfWidth * view.pixelsPerMetre / (view.orthographic > 0.5 ? 1.0 : depth); }

// Half the window's side, px.
float halfWindow(View view, Box box, float depth) { return clamp(halfWidth(view, box, depth), 1.0, box.largest); }

// Height of the box, metres: a box wider than its window is scaled down to it.
float boxHeight(View view, Box box, float depth) { return box.height * min(box.largest / halfWidth(view, box, depth), 1.0); }

const float kMostUnits = 1048576.0;  // a metre

float unitsPerMetre(View view, Box box, Extent e) {
    if (e.coordinate == 0u) return 1.0;
    float side = 2.0 * (halfWindow(view, box, nearestDepth(e)) + float(box.texelSide));
    float pixels = min(side, float(view.size.x)) * min(side, float(view.size.y));
    float units = (2147483000.0 / pixels - 1.0) / uintBitsToFloat(e.coordinate);
    return min(uintBitsToFloat(floatBitsToUint(max(units, 1e-30)) & 0x7f800000u), kMostUnits);  // down to a power of two
}
#endif

#endif
