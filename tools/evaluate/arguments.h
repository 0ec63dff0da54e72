// Options that the measuring programs share.
#pragma once

#include <CLI/CLI.hpp>

#include "candidate.h"

namespace obscura::evaluate {

// An option that takes a list with commas, and may be repeated.
CLI::Option* takeAll(CLI::Option* option);

// --method, --preset, --set, --offscreen in the group that is current.
struct Judged {
    std::vector<std::string> methods{"hbao"}, presets{"default"}, sets;
    std::string offscreen, resolve;
    std::vector<std::string> allSets() const;  // --offscreen and --resolve among them
};
void addJudged(CLI::App& cli, Judged& into, const char* setHelp = "METHOD.PARAMETER=VALUE, or PARAMETER=VALUE for all that have it; may be repeated");

// --device, --validation, --verbose and their group.
void addDevice(CLI::App& cli, std::string& device, std::string& validation, bool& verbose);

// The line as it is told in results: without --out, --table, --compare and --device, which say where things are here.
std::string commandOf(const char* program, int argc, const char* const* argv);

}  // namespace obscura::evaluate
