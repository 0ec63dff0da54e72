// Spatio-temporal noise [XeGTAO]: the index along a Hilbert curve over 64x64 pixels selects a point of the R2 sequence [Roberts 2018, The
// Unreasonable Effectiveness of Quasirandom Sequences], so that neighbouring pixels get distant points. Each frame adds 288 to the index.
#ifndef OBSCURA_HILBERT_GLSL
#define OBSCURA_HILBERT_GLSL
#include "shared/view.h"

// Index along the curve of order 6. Each level appends the quadrant's rank and transforms p into the quadrant's frame.
uint hilbertIndex(uvec2 p) {
    p &= 63u;
    uint index = 0u;
    for (int bit = 5; bit >= 0; --bit) {
        uvec2 half_ = (p >> bit) & 1u;
        index = index << 2 | ((3u * half_.x) ^ half_.y);
        p = half_.y == 0u && half_.x == 1u ? 63u - p : p;
        p = half_.y == 0u ? p.yx : p;
    }
    return index;
}
vec2 hilbertNoise(View view, ivec2 pixel) {
    uint index = hilbertIndex(uvec2(pixel)) + (view.temporal != 0u ? 288u * (view.frame & 63u) : 0u);
    return fract(0.5 + float(index) * vec2(0.754877666, 0.569840291));
}

#endif
