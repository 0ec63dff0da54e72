// Push constants of volumetric.
#ifndef OBSCURA_VOLUMETRIC_CONSTANTS_H
#define OBSCURA_VOLUMETRIC_CONSTANTS_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct VolumetricLines {  // lines.comp
    uint lines;
    float radius;     // metres, of the ball
    float thickness;  // metres, of all surfaces
    uint solid;       // 0: ball around the pixel, 1: its half above the tangent plane, 2: ball that touches the tangent plane at the pixel
    float columns;    // of pixels in a length of one row: 1 for square pixels
};
OBSCURA_SHARED_SIZE(VolumetricLines, 20);

OBSCURA_SHARED_END
#endif
