#include "settings.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"

namespace obscura::game {

namespace fs = std::filesystem;

namespace {

constexpr const char* kTitle = "# Settings of obscura, written when its window closes. Delete this file to start afresh.";

std::string quoted(const std::string& word) {
    const bool plain = !word.empty() && std::all_of(word.begin(), word.end(),
                                            [](unsigned char c) { return std::isalnum(c) || std::strchr("-_.,:/=@+%", c); });
    if (plain) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
    return text + "'";
}

}  // namespace

fs::path settingsFile() {
    if (const char* config = std::getenv("XDG_CONFIG_HOME"); config && *config) return fs::path(config) / "obscura" / "settings";
    if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".config" / "obscura" / "settings";
    return {};
}

std::vector<Argument> readSettings(const fs::path& file) {
    std::vector<Argument> settings;
    std::ifstream in(file);
    std::string line;
    for (size_t number = 1; std::getline(in, line); ++number) {
        if (line.empty() || line[0] == '#') continue;
        if (!line.starts_with("--") || line.size() > 1000)
            throw app::Complaint(fmt::format("{}: line {} is no option such as '--guard 0.1'", file.string(), number));
        const size_t space = std::min(line.find(' '), line.size());
        settings.push_back({line.substr(0, space), line.substr(std::min(space + 1, line.size()))});
    }
    return settings;
}

void writeSettings(const fs::path& file, const std::vector<Argument>& settings) {
    std::string text = std::string(kTitle) + "\n";
    for (const auto& [option, value] : settings) text += value.empty() ? option + "\n" : fmt::format("{} {}\n", option, value);
    app::expectFolder(file.parent_path());
    app::writeFile(file, text);
}

std::string asText(const std::vector<Argument>& options) {
    std::string text;
    for (const auto& [option, value] : options)
        text += (text.empty() ? "" : " ") + (value.empty() ? option : fmt::format("{} {}", option, quoted(value)));
    return text;
}

}  // namespace obscura::game
