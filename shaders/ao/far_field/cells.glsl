// Cells of all directions, consecutive texels of an image, which is faster to read than a buffer. A cell is a point (grid.glsl) or, with
// SUMS, a prefix sum (prefix.comp). Define CELLS_BINDING and CELLS_ACCESS (readonly, writeonly) first.
#ifndef OBSCURA_FAR_FIELD_CELLS_GLSL
#define OBSCURA_FAR_FIELD_CELLS_GLSL
#include "ao/far_field/constants.h"

#ifdef SUMS
const uint kAveraging = 1u;  // kPrefix
layout(set = 0, binding = CELLS_BINDING, rgba32ui) uniform CELLS_ACCESS uimage2D cells;
#else
layout(constant_id = 0) const uint kAveraging = 2u;
layout(set = 0, binding = CELLS_BINDING, r32ui) uniform CELLS_ACCESS uimage2D cells;
#endif

#endif
