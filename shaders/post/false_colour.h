// Diverging colour map of signed values, such as differences of visibility: near black at 0, blue to pale below, orange to pale above.
// Equal sizes have equal lightness, and colour-blind readers can tell the hues apart. Stops at 0, 1/2 and 1 of the range; sRGB bytes.
#ifndef OBSCURA_POST_FALSE_COLOUR_H
#define OBSCURA_POST_FALSE_COLOUR_H
#include "shared/types.h"

#ifdef __cplusplus
#define OBSCURA_RAMP(name, a, b, c, d, e, f, g, h, i) inline constexpr float name[3][3] = {{a, b, c}, {d, e, f}, {g, h, i}}
#else
#define OBSCURA_RAMP(name, a, b, c, d, e, f, g, h, i) const vec3 name[3] = vec3[3](vec3(a, b, c), vec3(d, e, f), vec3(g, h, i))
#endif

OBSCURA_SHARED_BEGIN
OBSCURA_RAMP(kBelow, 12, 12, 16, 32, 96, 200, 190, 225, 255);
OBSCURA_RAMP(kAbove, 12, 12, 16, 208, 88, 16, 255, 226, 170);
OBSCURA_SHARED_END

#endif
