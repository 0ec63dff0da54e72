// What every program's command line needs beside CLI11: numbers and sizes as text, and mistakes told in one line.
#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace CLI {
class App;
class ParseError;
}

namespace obscura::app {

// All of `text` as finite numbers between the separators; empty when it is anything else.
std::vector<float> numbers(const std::string& text, char separator);
// "1280x720", px; throws Complaint that says how a size is written.
glm::uvec2 sizeOf(const std::string& text);
// CLI11 says what is wrong; this adds what to do. Throws Complaint.
[[noreturn]] void complain(const CLI::App& cli, const CLI::ParseError& error);

}  // namespace obscura::app
