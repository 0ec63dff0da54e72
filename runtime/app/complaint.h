// What a user did that cannot work, as one line: what, where, what to do. main() prints it and exits with kBadInput.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::app {

inline constexpr int kFailed = 1;      // the machine could not do it
inline constexpr int kBadInput = 2;    // the command line or a file was wrong
inline constexpr int kInvalidUse = 3;  // it ran, but the validation layer had something to say

struct Complaint : std::runtime_error {
    explicit Complaint(const std::string& line, int exitCode = kBadInput) : std::runtime_error(line), code(exitCode) {}
    int code;
};

// Runs a program's body: what it throws becomes one line on stderr, "program: what", and an exit code.
int guarded(const char* program, const std::function<int()>& body);

// The name nearest to a mistyped one; empty when none is near.
std::string nearest(std::string_view wrong, const std::vector<std::string>& names);
// "did you mean hbao? there are: ssao, hbao, gtao" - the tail of a complaint about an unknown name.
std::string choices(std::string_view wrong, const std::vector<std::string>& names);
// Line breaks and tabs become blanks, so that whatever a library says stays one line.
std::string oneLine(std::string_view text);

}  // namespace obscura::app
