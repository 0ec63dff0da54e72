// Runs the game as a child process and returns its output.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace obscura::test {

struct Ran {
    int code = -1;  // exit code, or 128 + signal
    std::string out, err;
};
// Runs the game, or another program, without a display, with its own cache folder unless OBSCURA_CACHE is set.
Ran run(const std::vector<std::string>& arguments, const char* program = OBSCURA_GAME);

struct Decoded {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;  // empty: incomplete PNG
};
Decoded decodePng(const std::filesystem::path& file);
std::string bytesOf(const std::filesystem::path& file);

}  // namespace obscura::test
