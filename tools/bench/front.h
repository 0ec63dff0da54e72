// Pareto fronts of error and time, and the time budgets at which a baseline method has the least error.
#pragma once

#include <vector>

#include "results.h"

namespace obscura::bench {

// A range of time budgets, ms, at which the best baseline method within budget has less error than the best of ours.
struct Gap {
    double from = 0.0, to = 0.0;  // to: infinite if none of ours is better at any higher budget
    size_t baseline = 0;          // of Results::rows
    size_t ours = kNone;          // kNone: none of ours is within budget
    static constexpr size_t kNone = ~size_t(0);
};

// All candidates on one shot with one falloff against one reference. Indices are of Results::rows; the picture without obscurance is left
// out.
struct Front {
    std::string scene, camera, falloff, reference;
    uint32_t width = 0, height = 0;
    std::vector<size_t> rows;
    std::vector<size_t> line;   // the Pareto front, by time: no other is better in both time and error
    std::vector<Gap> gaps;      // empty: one of ours has the least error at every budget
    bool both = false;          // contains baseline methods and others
    std::string title() const;  // "sponza own 640x360 quadratic:2, world"
};
std::vector<Front> fronts(const Results& results);
std::string gapText(const Gap& gap, const Results& results, const std::string& reference);  // one line

}  // namespace obscura::bench
