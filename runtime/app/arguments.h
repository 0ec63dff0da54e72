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
// Reads the command line. False: it asked for help or the version, which is printed. What CLI11 finds wrong is thrown as a
// Complaint that adds what to do.
bool parse(CLI::App& cli, int argc, const char* const* argv);

}  // namespace obscura::app
