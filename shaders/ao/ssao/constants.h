// Push constants of ssao.
#ifndef OBSCURA_SSAO_CONSTANTS_H
#define OBSCURA_SSAO_CONSTANTS_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct SsaoPoints {  // points.comp
    uint samples;
    float radius;  // metres
    float bias;    // metres by which the depth buffer must be nearer than a point
};
OBSCURA_SHARED_SIZE(SsaoPoints, 12);

OBSCURA_SHARED_END
#endif
