// GPU costs of methods and presets as tables, JSON and CSV, and their comparison with a stored baseline.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "gpu_cost/cost.h"

namespace obscura::gpu_cost {

struct Row {
    std::string method, preset, settings;  // settings: over the preset
    std::string geometry;                  // what the frame must render besides: depth layers, by ao::LayerMode; voxels
    bool baseline = false;                 // a published method to compare with
    MethodCost cost;
    std::string label() const;
};
struct Table {
    std::string chip, driver, falloff;  // driver: "Mesa 22.3.6"; other versions count differently
    uint32_t width = 0, height = 0;
    std::vector<Row> rows;
};

struct Wanted {
    std::vector<const Chip*> chips;
    ao::Falloff falloff;
    std::string falloffText;
    uint32_t width = 1920, height = 1080;
    struct Candidate {
        ao::Values values;
        std::string preset, settings;
    };
    std::vector<Candidate> candidates;
};
// A table for each chip. `device` runs nothing, but makes the methods' pipelines; progress(done, all) is called after each row. Throws
// app::Complaint, with what is missing, where a chip has no compiler.
std::vector<Table> measure(gpu::Device& device, const Wanted& wanted, const std::function<void(size_t, size_t)>& progress);

std::string markdown(const Table& table);
std::string csv(const std::vector<Table>& tables);  // a line for each pass
std::string jsonText(const std::vector<Table>& tables);

// The baseline: cycles, registers, waves and spills of each pass.
std::string baselineText(const std::vector<Table>& tables);
struct Verdict {
    std::vector<std::string> worse, better, missing;  // missing: rows of the tables that the baseline lacks
    std::string incomparable;                         // why nothing was compared: the baseline is of another driver
    size_t compared = 0;
    bool passes() const { return worse.empty() && missing.empty(); }
};
// A pass is worse when it takes over 3 % more cycles (and more than 2), when fewer waves fit, or when it spills more.
Verdict compare(const std::vector<Table>& tables, const std::filesystem::path& baseline);  // throws app::Complaint on a malformed file

}  // namespace obscura::gpu_cost
