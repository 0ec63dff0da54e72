// Runs programs through the shell. Arguments are quoted, so paths may contain spaces, quotes and non-ASCII letters.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include <sys/wait.h>

#include "temporary_folder.h"

namespace obscura::test {

// Quotes a string as one word of a POSIX shell.
inline std::string quoted(std::string_view text) {
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}
inline std::string quoted(const std::filesystem::path& path) { return quoted(std::string_view(path.native())); }
inline std::string quoted(const std::string& text) { return quoted(std::string_view(text)); }
inline std::string quoted(const char* text) { return quoted(std::string_view(text)); }

// `format` with each {} replaced by the next argument, quoted: shellCommand("{} --json {}", program, file).
template <class... Arguments> std::string shellCommand(std::string_view format, const Arguments&... arguments) {
    std::string line;
    const auto put = [&](const std::string& word) {
        const size_t at = format.find("{}");
        if (at == format.npos) throw std::logic_error("more arguments than {} in a shell command");
        line += std::string(format.substr(0, at)) + word;
        format.remove_prefix(at + 2);
    };
    (put(quoted(arguments)), ...);
    if (format.find("{}") != format.npos) throw std::logic_error("fewer arguments than {} in a shell command");
    return line + std::string(format);
}

struct Ended {
    int code = -1;           // exit code; -1: ended by a signal
    std::string out, error;  // stdout and stderr
    size_t errorLines() const {
        size_t count = 0;
        for (const char c : error) count += c == '\n';
        return count;
    }
};

// Runs a command line and waits until it exits.
inline Ended runShell(const std::string& line) {
    const TemporaryFolder folder;
    const auto textOf = [](const std::filesystem::path& file) {
        std::ostringstream text;
        text << std::ifstream(file, std::ios::binary).rdbuf();
        return text.str();
    };
    const int status = std::system((line + " >" + quoted(folder / "out") + " 2>" + quoted(folder / "error")).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, textOf(folder / "out"), textOf(folder / "error")};
}

}  // namespace obscura::test
