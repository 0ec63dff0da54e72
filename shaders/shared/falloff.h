// The falloff rho(d): weight of an occluder at d metres, 1 at d = 0. One type for all methods and both references, evaluated by one
// formula without branches, so that every kind costs the same:
//     rho(d) = clamp(c0 + c1 d + ... + c5 d^5, 0, 1) * 2^(-decay d)   for d <= reach, else 0
#ifndef OBSCURA_SHARED_FALLOFF_H
#define OBSCURA_SHARED_FALLOFF_H
#include "types.h"
OBSCURA_SHARED_BEGIN

struct FalloffBlock {  // made by ao::falloffBlock()
    float c0, c1, c2, c3, c4, c5;  // per metre, metre^2, ...
    float decay;                   // per metre; 0 except for exponential
    float reach;                   // metres; beyond it rho is 0
};
OBSCURA_SHARED_SIZE(FalloffBlock, 32);

OBSCURA_SHARED_END

#ifndef __cplusplus
float falloff(FalloffBlock f, float d) {
    float polynomial = f.c0 + d * (f.c1 + d * (f.c2 + d * (f.c3 + d * (f.c4 + d * f.c5))));
    return d <= f.reach ? clamp(polynomial, 0.0, 1.0) * exp2(-f.decay * d) : 0.0;
}
#endif

#endif
