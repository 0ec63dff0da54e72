// What the windowed game remembers between starts: options of its command line, in a file with one option a line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace obscura::game {

struct Argument {
    std::string option, value;  // "--size", "1280x720"; flags have no value
    bool operator==(const Argument&) const = default;
};

// "obscura/settings" in $XDG_CONFIG_HOME or ~/.config; empty without either.
std::filesystem::path settingsFile();
// None if the file is missing. Throws app::Complaint if it is not of that form.
std::vector<Argument> readSettings(const std::filesystem::path& file);
void writeSettings(const std::filesystem::path& file, const std::vector<Argument>& settings);  // throws app::Complaint

std::string asText(const std::vector<Argument>& options);  // quoted for a shell

}  // namespace obscura::game
