// Command-line helpers on top of CLI11: numbers and sizes as text, errors in one line.
#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace CLI {
class App;
}

namespace obscura::app {

// `text` as finite numbers between separators; empty if any part of it is not one.
std::vector<float> numbers(const std::string& text, char separator);
// "1280x720", px; throws Complaint if malformed or out of range.
glm::uvec2 sizeOf(const std::string& text);
// Quotes a word for a POSIX shell where needed.
std::string shellWord(const std::string& word);
// Help text of --offscreen in every program.
inline constexpr const char* kOffScreenHelp =
    "off; offscreen: also traces voxels for occluders outside the image; hidden: and for those behind the visible surface "
    "(short for --set offscreen=...)";
// Parses the command line. False: help or the version was requested and has been printed. Throws Complaint, with a hint.
bool parse(CLI::App& cli, int argc, const char* const* argv);

}  // namespace obscura::app
