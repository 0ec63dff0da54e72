// The method to start with: the most accurate one whose measured cost fits a budget. And what is known of every preset's accuracy.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ao/method.h"

namespace obscura::game {

// The default of --budget, ms of GPU time: software devices draw no frame in the time of a GPU's.
constexpr double kBudget = 2.0, kSoftwareBudget = 60.0;

// Settings to choose from, from the cheapest to the most accurate, with the resolve preset `temporal`.
std::vector<ao::Values> candidates();

// Which of the candidates to use. `costs`: ms of the first ones, in order; the most accurate within the budget is chosen, or the first one.
struct Recommendation {
    size_t candidate = 0;
    std::vector<double> costs;  // ms, as measured
    double budget = 0.0;        // ms
    // One line: "layered high takes 1.4 of 2 ms; layered ultra would take 2.6".
    std::string reason() const;
};
Recommendation recommend(std::vector<double> costs, double budget);

// Measured figures of a preset; see content/methods.json, written by tools/renew.
struct Figures {
    double eA = 0.0;                // mean absolute error of visibility, mean over the scenes
    std::optional<double> flicker;  // F_e
    std::optional<double> cycles;   // a pixel on navi21, geometry apart
};
class KnownFigures {
public:
    KnownFigures();  // none if the file is missing; throws scene::Error if it is broken
    // Of a method's preset; empty if they are not known.
    std::optional<Figures> of(const std::string& method, const std::string& preset) const;

private:
    struct Entry {
        std::string method, preset;
        Figures figures;
    };
    std::vector<Entry> m_entries;
};

}  // namespace obscura::game
