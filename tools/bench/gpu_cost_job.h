// obscura-bench --gpu-cost: what methods cost on a GPU, counted by its compiler.
#pragma once

#include "options.h"

namespace obscura::bench {

// Prints the tables, writes gpu_cost.json, .csv and .md to the output folder, or checks or renews a baseline. Returns the exit code;
// kNothingCompared where the baseline is of another driver. Throws app::Complaint.
inline constexpr int kNothingCompared = 77;  // as tests say that they were skipped
int countGpuCost(const Options& options);

}  // namespace obscura::bench
