// Spatio-temporal noise [XeGTAO]: the index along a Hilbert curve over 64x64 pixels selects a point of the R2 sequence [Roberts 2018, The
// Unreasonable Effectiveness of Quasirandom Sequences], so that neighbouring pixels get distant points. Each frame adds 288 to the index.
#ifndef OBSCURA_HILBERT_GLSL
#define OBSCURA_HILBERT_GLSL
#include "shared/view.h"

// Index along the curve of order 6. In each level a quadrant has a rank and is traversed in one of four orientations (bits: axes swapped,
// axes reversed). Two bits for each orientation and quadrant (x, y): its rank, and the orientation inside it.
uint hilbertIndex(uvec2 p) {
    const uint kRank = 0x361e9cb4u, kInside = 0x8fe65831u;
    uint index = 0u, orientation = 0u;
    for (int bit = 5; bit >= 0; --bit) {
        int at = int(orientation << 3 | bitfieldExtract(p.x, bit, 1) << 2 | bitfieldExtract(p.y, bit, 1) << 1);
        index = index << 2 | bitfieldExtract(kRank, at, 2);
        orientation = bitfieldExtract(kInside, at, 2);
    }
    return index;
}
vec2 hilbertNoise(View view, ivec2 pixel) {
    uint index = hilbertIndex(uvec2(pixel)) + (view.temporal != 0u ? 288u * (view.frame & 63u) : 0u);
    return fract(0.5 + float(index) * vec2(0.754877666, 0.569840291));
}

#endif
