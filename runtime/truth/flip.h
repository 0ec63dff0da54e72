// FLIP, a difference evaluator for alternating images [Andersson 2020, LDR-FLIP]. An own implementation: the distribution has no package.
// tests/truth compares it with closed forms and with a direct evaluation by 2D kernels; it has not been compared with the authors' program.
#pragma once

#include <array>

#include "truth/picture.h"

namespace obscura::truth {

inline constexpr float kFlipPixelsPerDegree = 67.020643f;  // 0.7 m from a 0.7 m wide display of 3840 pixels

// Linear RGB in [0,1], of equal size. Result: 0 for no perceptible difference, at most 1.
Plane flip(const std::array<Plane, 3>& reference, const std::array<Plane, 3>& test, float pixelsPerDegree = kFlipPixelsPerDegree);

// Grey images: visibility as linear grey.
Plane flip(const Plane& reference, const Plane& test, float pixelsPerDegree = kFlipPixelsPerDegree);

}  // namespace obscura::truth
