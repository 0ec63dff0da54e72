// Runs the benchmark. Measurements are saved to OUT/parts every 2 s, so that an interrupted run resumes.
#pragma once

#include "options.h"
#include "results.h"

namespace obscura::bench {

// Throws app::Complaint or scene::Error.
Results measure(const Options& options, measure::Machine& machine);

}  // namespace obscura::bench
