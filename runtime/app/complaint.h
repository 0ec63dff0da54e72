// User errors: one line that says what is wrong, where, and what would be right. main() prints it and exits with the code.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::app {

inline constexpr int kFailed = 1;      // run-time failure: device, memory, disk
inline constexpr int kBadInput = 2;    // invalid command line or input file
inline constexpr int kInvalidUse = 3;  // the program ran, but the validation layer reported messages

struct Complaint : std::runtime_error {
    explicit Complaint(const std::string& line, int exitCode = kBadInput) : std::runtime_error(line), code(exitCode) {}
    int code;
};

// Runs a program's body. An exception becomes one line on stderr, "program: what", and an exit code.
int guarded(const char* program, const std::function<int()>& body);

// The name with the smallest edit distance to a mistyped one; empty if none is close.
std::string nearest(std::string_view wrong, const std::vector<std::string>& names);
// "did you mean hbao? available: ssao, hbao, gtao": ends an error about an unknown name.
std::string choices(std::string_view wrong, const std::vector<std::string>& names);
// Replaces each run of white space by one blank, so that a library's message is one line.
std::string oneLine(std::string_view text);

}  // namespace obscura::app
