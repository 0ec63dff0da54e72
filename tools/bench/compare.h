// Two runs held against each other: is anything slower, or worse, than it was?
#pragma once

#include <vector>

#include "results.h"

namespace obscura::bench {

struct Tolerances {
    double time = 0.05;                // of a row's time, beyond its noise
    double error = 0.03, errorFloor = 0.0005;     // of eA: relative and absolute, both must be passed
    double flicker = 0.05, flickerFloor = 1e-4;   // of F_e
    double memory = 0.01;
    bool absolute = false;             // milliseconds as they are
    double confidence = 0.95;
    uint32_t resamples = 2000;
};

// New over old. A row's rounds are taken as shares of what the other rows of its scene took in the same round, and its ratio
// over the median one of the scene, so that a machine that has become slower or faster as a whole cancels out; not so
// when a scene has a single row, or with Tolerances::absolute.
struct TimeChange {
    std::string name;
    double ratio = 1.0, low = 1.0, high = 1.0;  // with the bounds of the confidence interval: bootstrap over rounds
    bool worse = false, better = false;         // beyond tolerance and noise
    std::string dearest;                        // where worse: the pass that has grown most, "hbao.horizons 3.1 -> 4.4 ms"
};

struct Comparison {
    std::vector<TimeChange> times;
    double drift = 1.0;                // median ratio of all rows in milliseconds: machine, or what all methods share
    std::vector<std::string> worse;    // lines: errors, flicker, memory
    std::vector<std::string> missing;  // rows of the old run that the new one lacks
    size_t added = 0;                  // rows of the new run alone
    bool passes() const;
};
// Throws app::Complaint when the runs have no row in common, differ in device or have fewer than three rounds.
Comparison compare(const Results& before, const Results& now, const Tolerances& tolerances);
std::string comparisonText(const Comparison& comparison, const Tolerances& tolerances);

}  // namespace obscura::bench
