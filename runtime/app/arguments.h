// What every program's command line needs beside CLI11: numbers and sizes as text, and mistakes told in one line.
#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace CLI {
class App;
}

namespace obscura::app {

// All of `text` as finite numbers between the separators; empty when it is anything else.
std::vector<float> numbers(const std::string& text, char separator);
// "1280x720", px; throws Complaint that says how a size is written.
glm::uvec2 sizeOf(const std::string& text);
// A word as a shell reads it back.
std::string shellWord(const std::string& word);
// What --offscreen says of itself in every program.
inline constexpr const char* kOffScreenHelp =
    "off, offscreen or hidden: occluders from voxels that the picture does not show, outside of it or hidden in it too (short for --set offscreen=...)";
// Reads the command line. False: it asked for help or the version, which is printed. What CLI11 finds wrong is thrown as a
// Complaint that adds what to do.
bool parse(CLI::App& cli, int argc, const char* const* argv);

}  // namespace obscura::app
