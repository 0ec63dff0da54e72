// The shape of pixels, for methods that measure lengths in the image.
#ifndef OBSCURA_PIXEL_SHAPE_GLSL
#define OBSCURA_PIXEL_SHAPE_GLSL
#include "shared/view.h"

// Columns and rows of a length that is one row high: (1, 1) for square pixels, (2, 1) for pixels half as wide as high.
vec2 pixelShape(View view) { return vec2(abs(view.project.x) / view.pixelsPerMetre, 1.0); }

#endif
