// Minimises what is dear to evaluate, over [0, 1]^n: NLopt's randomised DIRECT-L for the lie of the land, then Subplex from the best.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace obscura::tune {

// The same calls in the same order for the same seed and the same answers. `evaluate` says whether the point was new: only those count
// towards `evaluations`. Begins at `start`. Returns the best point.
struct Answer {
    double value = 0.0;
    bool fresh = true;
};
std::vector<double> search(const std::vector<double>& start, uint32_t evaluations, uint32_t seed, const std::function<Answer(const std::vector<double>&)>& evaluate);

}  // namespace obscura::tune
