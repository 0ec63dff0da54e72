// Command-line options shared by obscura-evaluate, -flythrough, -bench and -tune.
#pragma once

#include <CLI/CLI.hpp>

#include "measure/candidate.h"

namespace obscura::measure {

// An option that takes a list with commas, and may be repeated.
CLI::Option* takeAll(CLI::Option* option);

// --method, --preset, --set and --offscreen, in the current option group.
struct CandidateOptions {
    std::vector<std::string> methods{"hbao"}, presets{"default"}, sets;
    std::string offscreen, resolve;
    std::vector<std::string> allSets() const;  // including those of --offscreen and --resolve
};
void addCandidateOptions(CLI::App& cli, CandidateOptions& into,
    const char* setHelp = "METHOD.PARAMETER=VALUE, or PARAMETER=VALUE for all that have it; may be repeated");

// --device, --validation and --verbose, in their own group.
void addDevice(CLI::App& cli, std::string& device, std::string& validation, bool& verbose);

// The command line for results: without --out, --table, --compare and --device, which name local files and devices.
std::string commandOf(const char* program, int argc, const char* const* argv);

}  // namespace obscura::measure
