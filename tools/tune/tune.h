// A whole search: logged trials, repeated measurement of the best, measurement of the winner on held-out places.
#pragma once

#include "options.h"

namespace obscura::tune {

struct Trial {
    std::string settings;  // settings over the hand-set preset: "steps=6 bias=12"; empty: the preset itself
    Score score;
    double objective = 0.0;
};

struct Tuned {
    measure::Candidate hand, best;
    std::vector<Trial> trials;             // in the order of the search
    Trial training;                        // the winner, measured again
    Score heldOut;                         // ratios of the winner to the hand-set preset; time: median over rounds
    double timeLow = 1.0, timeHigh = 1.0;  // 95 % interval of it, bootstrap over rounds
    std::vector<std::string> legs;         // names of the flights of heldOut
    // Whether the winner is worth shipping: on held-out places at least 2 % less error on the mean, nowhere 2 % more, and time and flicker
    // within the limits.
    bool real(const Limits& limits) const;
};

Tuned tune(const Options& options, const measure::Candidate& hand, Course& training, Course& heldOut);

// A preset's values in the syntax of a method's source, "{"steps", 6}, {"bias", 12}": those that differ from the initial ones.
std::string presetText(const measure::Candidate& candidate);
std::string markdown(const Options& options, const std::vector<Tuned>& results);
std::string jsonText(const Options& options, const std::vector<Tuned>& results);

}  // namespace obscura::tune
