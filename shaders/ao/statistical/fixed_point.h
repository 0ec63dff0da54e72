// Fixed point of the frame: units per metre, chosen so that no window's sum exceeds 32 bits.
//
// A window has at most N pixels, the magnitude of a coordinate is at most M, the magnitudes over the frame add up to T, and rounding adds
// at most one unit a pixel. So a sum is at most min(N M, T) units + N, which is kept below 2^31. N is the window of the pixel nearest to
// the camera plus one table texel on each side. Without T a single distant pixel would take the precision of all others. Units are a power
// of two, so that small camera movements do not change them.
//
// M has a limit, at which a box is a few pixels wide and at least kLeastUnits high: surfaces beyond it are as sky.
// Depth is measured from the camera or, orthographic, from the nearest surface, because that camera's plane is arbitrary.
#ifndef OBSCURA_STATISTICAL_FIXED_POINT_H
#define OBSCURA_STATISTICAL_FIXED_POINT_H
#include "shared/types.h"

#ifdef __cplusplus
#define OBSCURA_STATISTICAL_FUNCTION inline
#else
#define OBSCURA_STATISTICAL_FUNCTION
#endif

OBSCURA_SHARED_BEGIN

struct Box {
    float halfWidth;     // of the box, metres
    float height;        // metres, along the normal
    float largest;       // half height on the screen is at most this, px
    uint texelSide;      // of the tables, px
    float limit;         // largest coordinate of a surface that counts, metres: limitOf()
    float columns;       // of pixels in a length of one row: 1 for square pixels
};
OBSCURA_SHARED_SIZE(Box, 24);

const float kMostSum = 2147483000.0f;

// Pixels of a window with this half height, and one more texel on each side, in a frame of this size. Edge pixels fill the last texels.
OBSCURA_STATISTICAL_FUNCTION float pixelsOfWindow(Box box, float halfSide, uvec2 size) {
    float side = float(box.texelSide), width = 2.0f * (halfSide * box.columns + side), height = 2.0f * (halfSide + side);
    float mostWidth = float(size.x + box.texelSide), mostHeight = float(size.y + box.texelSide);
    return (width < mostWidth ? width : mostWidth) * (height < mostHeight ? height : mostHeight);
}
// Box::limit: with the largest window there are kLeastUnits a box height, before they are rounded down to a power of two.
OBSCURA_STATISTICAL_FUNCTION float limitOf(Box box, uvec2 size) {
    const float kLeastUnits = 4.0f;
    return kMostSum / pixelsOfWindow(box, box.largest, size) * box.height / kLeastUnits;
}

OBSCURA_SHARED_END

#ifndef __cplusplus
#include "shared/view.h"

// Over all pixels that are not open, as bits of floats; all 0 if all are open. Orthographic, all that are not sky.
struct Extent {
    uint nearestInverted;  // ~nearest linear depth
    uint furthest;         // linear depth
    uint coordinate;       // largest magnitude of an eye-space x or y
    uint sum;              // of the largest magnitudes of a coordinate of each pixel, at least
};

float nearestDepth(Extent e) { return uintBitsToFloat(~e.nearestInverted); }
// Linear depth at which the tables' z is 0.
float originOf(View view, Extent e) { return view.orthographic > 0.5 ? nearestDepth(e) : 0.0; }

// Half the box's width, in heights of a pixel.
float halfWidth(View view, Box box, float depth) { return box.halfWidth * view.pixelsPerMetre / (view.orthographic > 0.5 ? 1.0 : depth); }

// Half the window's height, px.
float halfWindow(View view, Box box, float depth) { return clamp(halfWidth(view, box, depth), 1.0, box.largest); }

// Height of the box, metres: a box wider than its window is scaled down to it.
float boxHeight(View view, Box box, float depth) { return box.height * min(box.largest / halfWidth(view, box, depth), 1.0); }

const float kMostUnits = 1048576.0;  // a metre
const float kSumError = 1.0001;      // of Extent::sum, which is rounded

// Whether a surface is sky, or beyond the limit. z: its linear depth; origin: originOf().
bool isOpen(View view, Box box, float origin, vec3 here, float z) {
    return isSky(view, z) || max(z - origin, max(abs(here.x), abs(here.y))) > box.limit;
}

float unitsPerMetre(View view, Box box, Extent e) {
    if (e.furthest == 0u) return 1.0;
    float most = max(uintBitsToFloat(e.furthest) - originOf(view, e), uintBitsToFloat(e.coordinate));
    float pixels = pixelsOfWindow(box, halfWindow(view, box, nearestDepth(e)), view.size);
    float sum = min(pixels * min(most, box.limit), uintBitsToFloat(e.sum) * kSumError);
    float units = (kMostSum - pixels) / max(sum, 1e-30);
    return min(uintBitsToFloat(floatBitsToUint(max(units, 1e-30)) & 0x7f800000u), kMostUnits);  // down to a power of two
}
#endif

#endif
