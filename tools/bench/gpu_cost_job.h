// obscura-bench --gpu-cost: what methods cost on a GPU, counted by its compiler.
#pragma once

#include "gpu/device.h"
#include "options.h"
#include "results.h"

namespace obscura::bench {

// Prints the tables, writes gpu_cost.json, .csv and .md to the output folder, or checks or renews a baseline. Returns the exit code;
// kNothingCompared where the baseline is of another driver. Throws app::Complaint.
inline constexpr int kNothingCompared = 77;  // as tests say that they were skipped
int countGpuCost(const Options& options);

// Adds GPU costs, counted for navi21 with each row's falloff, to the rows of these options' candidates. Without a compiler: one line that
// says what is missing, and no costs.
void addGpuCosts(const Options& options, gpu::Device& device, Results& results);

}  // namespace obscura::bench
