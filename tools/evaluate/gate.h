// The accuracy baseline: a file of errors that later measurements must not exceed, one cell per method, preset, scene, camera, falloff and
// reference. The file also stores the settings of the measurement.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "report.h"

namespace obscura::evaluate {

struct Cell {
    std::string method, preset, scene, camera, falloff, reference;
    std::string name() const;  // "hbao 8x4, toasters scene:0, quadratic:2, world"
    auto operator<=>(const Cell&) const = default;
};

struct Baseline {
    glm::uvec2 size{240, 135};
    float guard = 0.1f;
    uint32_t rays = 64, seed = 1;
    float relative = 0.03f, absolute = 0.0005f;  // a cell fails if its error grows by more than both
    std::vector<std::string> scenes, cameras, falloffs, references;
    std::map<Cell, float> cells;  // eA
};

Baseline readBaseline(const std::filesystem::path& file);  // throws scene::Error
std::string baselineText(const Baseline& baseline);        // the file's text, one line per cell

struct Verdict {
    std::vector<std::string> worse, missing;  // lines; either fails the gate
    std::vector<std::string> better;          // cells that improved by more than both tolerances
    std::vector<std::string> gone;            // cells of methods or presets that no longer exist
    bool passes() const { return worse.empty() && missing.empty(); }
};
Verdict judge(const Baseline& baseline, const std::map<Cell, float>& measured);

// The exit code.
int checkBaseline(const Options& options);
int renewBaseline(const Options& options);

}  // namespace obscura::evaluate
