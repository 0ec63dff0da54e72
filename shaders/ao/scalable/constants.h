// Push constants of scalable.
#ifndef OBSCURA_SCALABLE_CONSTANTS_H
#define OBSCURA_SCALABLE_CONSTANTS_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct ScalableSpiral {  // spiral.comp
    uint samples;
    uint turns;       // of the spiral
    float radius;     // metres
    float intensity;  // sigma
    float bias;       // metres
};
OBSCURA_SHARED_SIZE(ScalableSpiral, 20);

struct ScalableBlur {  // blur.comp
    uint vertical;  // 1: down the columns, 0: along the rows
    float radius;   // metres
};
OBSCURA_SHARED_SIZE(ScalableBlur, 8);

OBSCURA_SHARED_END
#endif
