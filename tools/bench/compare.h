// Compares two runs: regressions in time, error, flicker and memory.
#pragma once

#include <vector>

#include "results.h"

namespace obscura::bench {

struct Tolerances {
    double time = 0.05;                          // relative growth of a row's time, in addition to its confidence interval
    double error = 0.03, errorFloor = 0.0005;    // of eA: relative and absolute; a regression exceeds both
    double flicker = 0.05, flickerFloor = 1e-4;  // of F_e
    double memory = 0.01;
    bool absolute = false;  // compare milliseconds, not shares of a round
    double confidence = 0.95;
    uint32_t resamples = 2000;
};

// Ratio of new to old time. A row's rounds are divided by the geometric mean of its scene's rows in the same round, and its ratio by the
// scene's median ratio, so that a change of the whole machine's speed cancels out. Milliseconds are compared if a scene has one row only,
// or with Tolerances::absolute.
struct TimeChange {
    std::string name;
    double ratio = 1.0, low = 1.0, high = 1.0;  // with the bounds of the confidence interval: bootstrap over rounds
    bool worse = false, better = false;         // beyond tolerance and noise
    std::string dearest;                        // if worse: the pass that has grown most, "hbao.horizons 3.1 -> 4.4 ms"
};

struct Comparison {
    std::vector<TimeChange> times;
    double drift = 1.0;                // median ratio of all rows in milliseconds: speed of the machine, or passes that all methods share
    std::vector<std::string> worse;    // lines: errors, flicker, memory
    std::vector<std::string> missing;  // rows of the old run that the new one lacks
    size_t added = 0;                  // rows only in the new run
    bool passes() const;
};
// Throws app::Complaint when the runs have no row in common, differ in device or have fewer than three rounds.
Comparison compare(const Results& before, const Results& now, const Tolerances& tolerances);
std::string comparisonText(const Comparison& comparison, const Tolerances& tolerances);

}  // namespace obscura::bench
