// Push constants of temporal anti-aliasing.
#ifndef OBSCURA_POST_ANTIALIAS_H
#define OBSCURA_POST_ANTIALIAS_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct AntialiasBlock {
    // Rows: (pixel, 1) of the whole image -> last frame's pixel of the sky there, homogeneous. The third coordinate is the factor from
    // linear depth to last frame's, to which [2].w is added, metres.
    vec4 previousPixel[3];
    uvec2 visible;          // px
    uvec2 guard;            // px before the visible part
    float exposure;
    uint unused[3];
};
OBSCURA_SHARED_SIZE(AntialiasBlock, 80);

OBSCURA_SHARED_END
#endif
