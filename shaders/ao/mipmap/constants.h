// Push constants of mipmap.
#ifndef OBSCURA_MIPMAP_CONSTANTS_H
#define OBSCURA_MIPMAP_CONSTANTS_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct MipmapObscurance {  // obscurance.comp
    uint directions;  // K
    float factor;     // from step to step
    float unit;       // metres: the falloff's length
    float thickness;  // of surfaces, metres
    float jitter;     // of directions, fraction of a sector
    float first;      // px, distance of the first sample
    float step;       // px, to it from the one before
};
OBSCURA_SHARED_SIZE(MipmapObscurance, 28);

OBSCURA_SHARED_END
#endif
