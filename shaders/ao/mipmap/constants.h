// Push constants of mipmap.
#ifndef OBSCURA_MIPMAP_CONSTANTS_H
#define OBSCURA_MIPMAP_CONSTANTS_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct MipmapReduce {  // reduce.comp
    ivec2 finer, coarser;  // sizes, px
};
OBSCURA_SHARED_SIZE(MipmapReduce, 16);

struct MipmapObscurance {  // obscurance.comp
    uint directions;  // K
    float factor;     // from step to step
    float unit;       // metres: the falloff's length
    float thickness;  // of surfaces, metres
    float jitter;     // of directions, fraction of a sector
    float first;      // px, distance of the first sample
    float step;       // px, to it from the one before
    uint levels;      // of the pyramid
};
OBSCURA_SHARED_SIZE(MipmapObscurance, 32);

OBSCURA_SHARED_END
#endif
