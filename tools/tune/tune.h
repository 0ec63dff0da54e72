// A search from end to end: trials kept as they come, the best measured again, the winner where it never trained.
#pragma once

#include "options.h"

namespace obscura::tune {

struct Trial {
    std::string settings;              // over the hand-set preset: "steps=6 bias=12"; empty: itself
    Score score;
    double objective = 0.0;
};

struct Tuned {
    evaluate::Candidate hand, best;
    std::vector<Trial> trials;         // in the order of the search
    Trial training;                    // the winner, measured again
    Score heldOut;                     // the winner over the hand-set one; time: median over rounds
    double timeLow = 1.0, timeHigh = 1.0;  // 95 % interval of it, bootstrap over rounds
    std::vector<std::string> legs;     // of heldOut
    // Whether the winner is worth shipping: at least two per cent less error where it never trained, nowhere two per cent more, and
    // neither dearer nor less calm than allowed.
    bool real(const Limits& limits) const;
};

Tuned tune(const Options& options, const evaluate::Candidate& hand, Course& training, Course& heldOut);

// A preset's values as they stand in a method's table, "{"steps", 6}, {"bias", 12}": all that differs from the initial ones.
std::string presetText(const evaluate::Candidate& candidate);
std::string markdown(const Options& options, const std::vector<Tuned>& results);
std::string jsonText(const Options& options, const std::vector<Tuned>& results);

}  // namespace obscura::tune
