// The stability baseline: flicker, static noise and lag of every method on short flythroughs, compared with a file in the repository.
#pragma once

#include <map>
#include <tuple>

#include "options.h"

namespace obscura::flythrough {

struct FlickerRow {
    double flickerOfError = 0.0, noise = 0.0;
    uint32_t t90 = 0;
};
using FlickerKey = std::tuple<std::string, std::string, std::string, std::string>;  // method, preset, flythrough, filter

struct FlickerBaseline {
    glm::uvec2 size{112, 63};
    uint32_t length = 32, rays = 256;
    double relative = 0.05, absolute = 1e-4;  // a row may grow by the larger of the two; T90 by `relative` of itself
    std::vector<std::string> flythroughs{"teleport", "close-up"}, filters{"spatial", "temporal"};
    std::map<FlickerKey, FlickerRow> rows;
};
FlickerBaseline readBaseline(const std::filesystem::path& file);  // throws scene::Error
std::string baselineText(const FlickerBaseline& baseline);

// Lines on rows that became worse and on rows missing from the file; empty: passed.
std::vector<std::string> judge(const FlickerBaseline& baseline, const std::map<FlickerKey, FlickerRow>& measured);

// Both print their result and return an exit code.
int checkBaseline(const Options& options);
int renewBaseline(const Options& options);

}  // namespace obscura::flythrough
