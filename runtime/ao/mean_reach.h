// Integral of a falloff over distance, for methods whose published form has a fixed falloff and only a radius. The radius matches a
// falloff when both integrals are equal.
#pragma once

#include "obscura/ao.h"

namespace obscura::ao {

inline float meanReach(const Falloff& falloff) {  // metres
    constexpr int kSteps = 256;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) sum += evaluate(falloff, (float(i) + 0.5f) / float(kSteps) * reach(falloff));
    return float(sum / kSteps) * reach(falloff);
}

}  // namespace obscura::ao
