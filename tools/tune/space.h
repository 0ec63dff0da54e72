// What of a method is searched: parameters as a cube [0, 1]^n around a start.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "candidate.h"

namespace obscura::tune {

class Space {
public:
    // The parameters named ("steps", or "METHOD.steps", which other methods pass over); none named: all numbers of the method's own, not
    // those it shares with others (history, off-screen occluders). Values above 0 go from a quarter of the start's to four times it,
    // in ratios; others through all of their range. Throws app::Complaint.
    Space(const evaluate::Candidate& start, const std::vector<std::string>& names);

    size_t size() const { return m_axes.size(); }
    std::vector<double> start() const;
    // The start with the values at a point, whole where they must be; Candidate::settings tell those that differ from the start.
    evaluate::Candidate at(std::span<const double> point) const;

private:
    struct Axis {
        const ao::Parameter* parameter;
        double low, high, start;
        bool ratios;
        double value(double u) const;
    };
    evaluate::Candidate m_start;
    std::vector<Axis> m_axes;
};

}  // namespace obscura::tune
