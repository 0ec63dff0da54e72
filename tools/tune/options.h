// The command line as a struct. Everything that can be judged without a device or a scene is judged here.
#pragma once

#include <filesystem>
#include <optional>

#include "course.h"

namespace obscura::tune {

struct Options {
    std::vector<evaluate::Candidate> hands;     // the presets that are to be beaten, and where searches start
    std::vector<std::string> parameters;        // empty: Space's choice
    std::vector<Place> training, heldOut;
    std::vector<evaluate::FalloffChoice> falloffs;
    flythrough::Settings flight;
    Limits limits;
    uint32_t evaluations = 80, rounds = 5, finalists = 4, seed = 1;
    std::filesystem::path out;
    bool again = false;
    std::string device, validation = "off", command;
    bool verbose = false;
};

// Throws app::Complaint. Nothing when the line asked for help, which has been printed.
std::optional<Options> parseOptions(int argc, const char* const* argv);

}  // namespace obscura::tune
