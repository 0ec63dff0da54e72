// How time grows: rows that differ in one thing alone, and the power of it that fits their times.
#pragma once

#include <vector>

#include "results.h"

namespace obscura::bench {

struct Fit {
    std::string axis;                  // "pixels", "radius", "triangles", or what was varied: "steps"
    std::string label, where;          // the candidate without what was varied; what all rows share
    std::vector<double> x, y;          // y: ms; at least three different x, ascending
    double exponent = 0.0, error = 0.0, factor = 0.0;  // y = factor x^exponent; standard error of the exponent
};
std::vector<Fit> fits(const Results& results);

// Least squares of log y over log x. Three points or more, all positive.
void fit(Fit& line);

}  // namespace obscura::bench
