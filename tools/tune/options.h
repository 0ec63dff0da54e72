// The command line as a struct. Parsing checks everything that needs neither a device nor a scene.
#pragma once

#include <filesystem>
#include <optional>

#include "course.h"

namespace obscura::tune {

struct Options {
    std::vector<measure::Candidate> hands;  // hand-set presets: starts of the searches, to which results are compared
    std::vector<std::string> parameters;    // empty: the default of Space
    std::vector<Place> training, heldOut;
    std::vector<measure::FalloffChoice> falloffs;
    flythrough::Settings flight;
    Limits limits;
    uint32_t evaluations = 80, rounds = 5, finalists = 4, seed = 1;
    std::filesystem::path out;
    bool again = false;
    bool cycles = false;  // the clock: GPU cycles instead of milliseconds
    std::string device, validation = "off", command;
    bool verbose = false;
};

// Throws app::Complaint. Empty after printing help.
std::optional<Options> parseOptions(int argc, const char* const* argv);

}  // namespace obscura::tune
