// The command line as a struct. Parsing checks everything that needs neither a device nor a scene.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "flight.h"
#include "measure/shot.h"

namespace obscura::bench {

struct Options {
    measure::Measurement what;  // scenes, cameras, falloffs, candidates, references, rays, times, device; its size is not used
    std::vector<glm::uvec2> sizes;
    std::vector<uint64_t> triangles;  // numbers of triangles of generated scenes, in addition to those of `what`
    std::optional<flythrough::Settings> flicker;
    std::filesystem::path out;
    std::filesystem::path from;          // results of an earlier run instead of measuring
    std::filesystem::path compare;       // results of an earlier run to compare with
    std::vector<std::string> gpuCost;    // chips whose compiler counts costs, instead of measuring; see gpu_cost/chip.h
    std::filesystem::path checkGpuCost;  // a baseline to compare these costs with
    std::filesystem::path renewGpuCost;  // a baseline to write
    bool withGpuCost = true;             // counted beside the measurement
    std::filesystem::path table;         // a Markdown file with markers of tables.h
    std::filesystem::path summary;       // a file for tables.h's summary()
    double tolerance = 0.05;             // relative growth of times allowed in addition to their confidence interval
    bool absolute = false;               // compare milliseconds
    bool again = false;                  // measure again what an earlier run measured
    std::string command;                 // the command line, for the results
};

// Throws app::Complaint. Empty after printing help.
std::optional<Options> parseOptions(int argc, const char* const* argv);

}  // namespace obscura::bench
