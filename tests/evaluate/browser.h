// A headless Chromium controlled through its remote-debugging pipe: key strokes and pointer moves on a real page.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <sys/types.h>
#include <nlohmann/json.hpp>

namespace obscura::evaluate {

class Browser {
public:
    // Null, with a one-line reason, if Chromium is not installed or does not answer. `profile`: an own folder.
    static std::unique_ptr<Browser> start(const std::filesystem::path& profile, std::string& reason);
    ~Browser();
    Browser(const Browser&) = delete;

    // Loads a page at a window size in CSS pixels and waits until it has loaded. False when that takes too long.
    bool open(const std::string& url, int width, int height, bool dark = false);
    nlohmann::json evaluate(const std::string& expression);  // value of a JavaScript expression, promises awaited; null if it throws
    void click(double x, double y);
    void drag(double x0, double y0, double x1, double y1);
    void key(const std::string& name, int code);                             // "ArrowRight", 39
    std::vector<std::byte> screenshot();                                     // PNG
    const std::vector<std::string>& requests() const { return m_requests; }  // URLs that the page requested, except itself and data:
    const std::vector<std::string>& errors() const { return m_errors; }      // exceptions and console errors

private:
    Browser() = default;
    nlohmann::json call(const std::string& method, nlohmann::json parameters = nlohmann::json::object());
    bool read(nlohmann::json& message, int milliseconds);
    void hear(const nlohmann::json& message);
    void mouse(const char* type, double x, double y, int buttons);

    pid_t m_process = -1;
    int m_in = -1, m_out = -1;
    int m_next = 1;
    bool m_loaded = false;
    std::string m_session, m_buffer;
    std::vector<std::string> m_requests, m_errors;
};

}  // namespace obscura::evaluate
