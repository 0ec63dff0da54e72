// The search space of a method: parameters mapped to a cube [0, 1]^n around a start.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "measure/candidate.h"

namespace obscura::tune {

class Space {
public:
    // Searches the named parameters ("steps", or "METHOD.steps", which other methods ignore). None named: all numeric parameters of the
    // method's own, without shared ones (history, off-screen occluders). A start above 0 spans 1/4 to 4 times its value on a logarithmic
    // scale; others span their whole range. Throws app::Complaint.
    Space(const measure::Candidate& start, const std::vector<std::string>& names);

    size_t size() const { return m_axes.size(); }
    std::vector<double> start() const;
    // The start with the values at a point, rounded for integer parameters; Candidate::settings lists those that differ from the start.
    measure::Candidate at(std::span<const double> point) const;

private:
    struct Axis {
        const ao::Parameter* parameter;
        double low, high, start;
        bool ratios;
        double value(double u) const;
    };
    measure::Candidate m_start;
    std::vector<Axis> m_axes;
};

}  // namespace obscura::tune
