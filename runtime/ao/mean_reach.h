// For methods whose published form has a falloff of its own and only a radius to set: the mean distance to which a falloff lets
// occluders count. A radius is right for a falloff when both means agree.
#pragma once

#include "obscura/ao.h"

namespace obscura::ao {

inline float meanReach(const Falloff& falloff) {  // metres: the integral of rho
    constexpr int kParts = 256;
    double sum = 0.0;
    for (int i = 0; i < kParts; ++i) sum += evaluate(falloff, (float(i) + 0.5f) / float(kParts) * reach(falloff));
    return float(sum / kParts) * reach(falloff);
}

}  // namespace obscura::ao
