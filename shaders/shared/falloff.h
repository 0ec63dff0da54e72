// The falloff rho(d): how much an occluder at d metres counts, 1 at d = 0. One type for every method and both references.
#ifndef OBSCURA_SHARED_FALLOFF_H
#define OBSCURA_SHARED_FALLOFF_H
#include "types.h"
OBSCURA_SHARED_BEGIN

// kind: 0 exponential exp(-d/a); 1 linear 1-d/a; 2 quadratic 1-(d/a)^2; 3 wendland (1-d/a)^4 (4d/a+1);
//       4 constant 1 up to a; 5 ramp 1 up to a, linear to 0 at b.
struct FalloffBlock {
    uint kind;
    float a;      // metres
    float b;      // metres, ramp only
    float reach;  // metres; beyond it rho counts as 0
};
OBSCURA_SHARED_SIZE(FalloffBlock, 16);

OBSCURA_SHARED_END

#ifndef __cplusplus
float falloff(FalloffBlock f, float d) {
    float x = d / f.a;
    float y = max(1.0 - x, 0.0);
    switch (f.kind) {
        case 0u: return d < f.reach ? exp(-x) : 0.0;
        case 1u: return y;
        case 2u: return max(1.0 - x * x, 0.0);
        case 3u: return y * y * y * y * (4.0 * x + 1.0);
        case 4u: return d <= f.a ? 1.0 : 0.0;
        default: return clamp((f.b - d) / max(f.b - f.a, 1e-6), 0.0, 1.0);
    }
}
#endif

#endif
