// Runs the game as a process of its own and keeps what it printed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace obscura::test {

struct Ran {
    int code = -1;  // exit code, or 128 + signal
    std::string out, err;
};
// With its own cache folder unless OBSCURA_CACHE names one, without a display. The game unless another program is named.
Ran run(const std::vector<std::string>& arguments, const char* program = OBSCURA_GAME);

// A folder of this test alone, empty at first.
std::filesystem::path freshFolder(const std::string& name);

struct Decoded {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;  // empty: no whole PNG
};
Decoded decodePng(const std::filesystem::path& file);
std::string bytesOf(const std::filesystem::path& file);

}  // namespace obscura::test
