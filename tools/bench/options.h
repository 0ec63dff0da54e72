// The command line as a struct. Everything that can be judged without a device or a scene is judged here.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "flight.h"
#include "shot.h"

namespace obscura::bench {

struct Options {
    evaluate::Options what;                  // scenes, cameras, falloffs, candidates, references, rays, times, device; its size is not used
    std::vector<glm::uvec2> sizes;
    std::vector<uint64_t> triangles;         // generated scenes of so many, beside those of `what`
    std::optional<flythrough::Settings> flicker;
    std::filesystem::path out;
    std::filesystem::path from;              // results of an earlier run instead of measuring
    std::filesystem::path compare;           // results of an earlier run to be held against
    std::filesystem::path table;             // a Markdown file with the markers of tables.h
    double tolerance = 0.05;                 // by which times may grow beyond their noise
    bool absolute = false;                   // compare milliseconds as they are
    bool again = false;                      // measure what is there already, too
    std::string command;                     // the line itself
};

// Throws app::Complaint. Nothing when the line asked for help, which has been printed.
std::optional<Options> parseOptions(int argc, const char* const* argv);

}  // namespace obscura::bench
