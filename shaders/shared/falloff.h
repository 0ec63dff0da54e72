// The falloff rho(d): weight of an occluder at d metres, 1 at d = 0. One type for all methods and both references. Its kind is a
// specialization constant, so that a shader contains the formula of one kind only; lengths may change from frame to frame.
#ifndef OBSCURA_SHARED_FALLOFF_H
#define OBSCURA_SHARED_FALLOFF_H
#include "types.h"
OBSCURA_SHARED_BEGIN

struct FalloffBlock {  // made by ao::falloffBlock()
    float start;       // ramp: value at d = 0 before clamping; else 1
    float slope;       // change per metre, of exponents for exponential; quadratic: per metre^2
    float reach;       // metres; beyond it rho is 0
};
OBSCURA_SHARED_SIZE(FalloffBlock, 12);

OBSCURA_SHARED_END

#define OBSCURA_FALLOFF_KIND 31  // id of the constant

#ifndef __cplusplus
layout(constant_id = OBSCURA_FALLOFF_KIND) const uint kFalloffKind = 0u;
const uint kExponential = 0u, kLinear = 1u, kQuadratic = 2u, kWendland = 3u, kConstant = 4u, kRamp = 5u;  // FalloffKind of ao.h

float falloffOf(uint kind, FalloffBlock f, float d) {
    if (kind == kExponential) return d <= f.reach ? exp2(f.slope * d) : 0.0;
    if (kind == kConstant) return d <= f.reach ? 1.0 : 0.0;
    if (kind == kQuadratic) return clamp(1.0 + f.slope * d * d, 0.0, 1.0);
    if (kind == kRamp) return clamp(f.start + f.slope * d, 0.0, 1.0);
    float y = clamp(1.0 + f.slope * d, 0.0, 1.0), y2 = y * y;
    return kind == kWendland ? y2 * y2 * (5.0 - 4.0 * y) : y;  // (1-x)^4 (4x+1), x = d / length
}
float falloff(FalloffBlock f, float d) { return falloffOf(kFalloffKind, f, d); }
#endif

#endif
