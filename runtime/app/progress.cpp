#include "app/progress.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace obscura::app {

using Clock = std::chrono::steady_clock;

Progress::Progress(std::string what, size_t total)
    : m_what(std::move(what)), m_total(std::max<size_t>(total, 1)), m_shown(::isatty(STDERR_FILENO) != 0), m_start(Clock::now()) {
    at(0);
}

Progress::~Progress() {
    if (m_shown) std::fputs("\r\033[K", stderr);
}

void Progress::at(size_t done, const std::string& item) {
    const auto now = Clock::now();
    // The first and the last call always draw, the others at most every 50 ms.
    if (!m_shown || (done && done < m_total && now - m_last < std::chrono::milliseconds(50))) return;
    m_last = now;
    constexpr size_t kWidth = 28;
    const size_t full = std::min(done, m_total) * kWidth / m_total;
    const double seconds = std::chrono::duration<double>(now - m_start).count();
    const std::string left = done ? fmt::format(", {:.0f} s left", seconds / double(done) * double(m_total - std::min(done, m_total))) : "";
    const std::string line = fmt::format(
        "\r\033[K{} [{}{}] {}/{}{} {:.24}", m_what, std::string(full, '#'), std::string(kWidth - full, '.'), done, m_total, left, item);
    std::fputs(line.c_str(), stderr);
    std::fflush(stderr);
}

}  // namespace obscura::app
