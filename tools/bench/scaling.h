// Scaling of time: power laws fitted to rows that differ in one quantity only.
#pragma once

#include <vector>

#include "results.h"

namespace obscura::bench {

struct Fit {
    std::string axis;          // "pixels", "radius", "triangles", or the varied parameter: "steps"
    std::string label, where;  // the candidate without the varied parameter; scene, camera, size and falloff shared by the rows
    std::vector<double> x, y;  // y: ms; at least three different x, ascending
    double exponent = 0.0, error = 0.0, factor = 0.0;  // y = factor x^exponent; standard error of the exponent
};
std::vector<Fit> fits(const Results& results);

// Least squares of log y over log x. Three points or more, all positive.
void fit(Fit& line);

}  // namespace obscura::bench
