// Minimises an expensive function over [0, 1]^n: NLopt's randomised DIRECT-L (global), then Subplex from the best point (local).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace obscura::tune {

// Deterministic for equal seeds and equal values. `evaluate` returns whether the point was new; only new points count towards
// `evaluations`. Begins at `start`. Returns the best point.
struct Answer {
    double value = 0.0;
    bool fresh = true;
};
std::vector<double> search(const std::vector<double>& start, uint32_t evaluations, uint32_t seed,
    const std::function<Answer(const std::vector<double>&)>& evaluate);

}  // namespace obscura::tune
