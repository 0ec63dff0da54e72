// A progress bar on stderr, hidden if stderr is not a terminal.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace obscura::app {

class Progress {
public:
    Progress(std::string what, size_t total);
    ~Progress();  // clears the line
    Progress(const Progress&) = delete;
    void at(size_t done, const std::string& item = {});

private:
    std::string m_what;
    size_t m_total;
    bool m_shown;
    std::chrono::steady_clock::time_point m_start, m_last;
};

}  // namespace obscura::app
