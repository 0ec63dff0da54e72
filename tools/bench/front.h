// Error against time: who is best at every millisecond.
#pragma once

#include <vector>

#include "results.h"

namespace obscura::bench {

// A span of time budgets, in ms, at which the best yardstick that fits in them is better than the best of ours.
struct Gap {
    double from = 0.0, to = 0.0;       // to: infinite where nothing dearer of ours is better
    size_t yardstick = 0;              // of Results::rows
    size_t ours = kNone;               // kNone: none of ours fits
    static constexpr size_t kNone = ~size_t(0);
};

// All candidates on one shot with one falloff against one reference. Indices are of Results::rows; the picture without obscurance is left out.
struct Front {
    std::string scene, camera, falloff, reference;
    uint32_t width = 0, height = 0;
    std::vector<size_t> rows;
    std::vector<size_t> line;          // those that no other beats in both time and error, by time
    std::vector<Gap> gaps;             // empty: one of ours is ahead at every budget that fits anything
    bool both = false;                 // there are yardsticks and others
    std::string title() const;         // "sponza own 640x360 quadratic:2, world"
};
std::vector<Front> fronts(const Results& results);
std::string gapText(const Gap& gap, const Results& results, const std::string& reference);  // one line

}  // namespace obscura::bench
