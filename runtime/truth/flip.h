// FLIP, a difference evaluator for alternating images [Andersson 2020, LDR-FLIP]. This project's own implementation: the
// distribution ships none. tests/truth holds it to closed forms and to the definition evaluated plainly, 2D kernel by 2D
// kernel; it has not been run beside the authors' program.
#pragma once

#include <array>

#include "truth/picture.h"

namespace obscura::truth {

inline constexpr float kFlipPixelsPerDegree = 67.020643f;  // 0.7 m from a 0.7 m wide display of 3840 pixels

// Linear RGB in [0,1], sizes equal. 0 where nobody sees a difference, at most 1.
Plane flip(const std::array<Plane, 3>& reference, const std::array<Plane, 3>& test, float pixelsPerDegree = kFlipPixelsPerDegree);

// Grey pictures: visibility taken as the linear reflectance of a grey display.
Plane flip(const Plane& reference, const Plane& test, float pixelsPerDegree = kFlipPixelsPerDegree);

}  // namespace obscura::truth
