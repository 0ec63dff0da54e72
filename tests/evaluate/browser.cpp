// Starts a headless Chromium and speaks its DevTools protocol over two pipes.
#include "browser.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace obscura::evaluate {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr int kPatience = 180000;  // ms to wait for an answer: a browser starts slowly on a loaded machine

std::string findChromium() {
    if (const char* named = std::getenv("OBSCURA_CHROMIUM")) return named;
    const char* path = std::getenv("PATH");
    for (const char* name : {"chromium", "chromium-browser", "google-chrome", "google-chrome-stable"}) {
        std::string folders = path ? path : "";
        for (size_t at = 0; at < folders.size();) {
            const size_t end = std::min(folders.find(':', at), folders.size());
            const fs::path file = fs::path(folders.substr(at, end - at)) / name;
            if (::access(file.c_str(), X_OK) == 0) return file.string();
            at = end + 1;
        }
    }
    return "";
}

std::vector<std::byte> fromBase64(const std::string& text) {
    std::vector<std::byte> bytes;
    uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                          : c >= 'a' && c <= 'z' ? c - 'a' + 26
                          : c >= '0' && c <= '9' ? c - '0' + 52
                          : c == '+'             ? 62
                          : c == '/'             ? 63
                                                 : -1;
        if (value < 0) continue;
        bits = bits << 6 | uint32_t(value);
        if ((count += 6) >= 8) bytes.push_back(std::byte(bits >> (count -= 8) & 255));
    }
    return bytes;
}

}  // namespace

std::unique_ptr<Browser> Browser::start(const fs::path& profile, std::string& reason) {
    const std::string program = findChromium();
    if (program.empty()) {
        reason = "no Chromium here: install the package chromium, or name one in OBSCURA_CHROMIUM";
        return nullptr;
    }
    int toBrowser[2], fromBrowser[2];
    if (::pipe2(toBrowser, O_CLOEXEC) != 0 || ::pipe2(fromBrowser, O_CLOEXEC) != 0) {
        reason = "no pipe to Chromium";
        return nullptr;
    }
    const std::string profileOption = "--user-data-dir=" + profile.string();
    const pid_t process = ::fork();
    if (process == 0) {
        // Chromium reads commands from descriptor 3 and answers on 4. Duplicated to higher ones first, since the pipes may use 3 and 4.
        const int in = ::fcntl(toBrowser[0], F_DUPFD, 10), out = ::fcntl(fromBrowser[1], F_DUPFD, 10),
                  nothing = ::open("/dev/null", O_RDWR);
        ::dup2(nothing, 0);
        ::dup2(nothing, 1);
        ::dup2(nothing, 2);
        ::dup2(in, 3);
        ::dup2(out, 4);
        ::setpgid(0, 0);
        ::execl(program.c_str(), program.c_str(), "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
            "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run", "--hide-scrollbars",
            profileOption.c_str(), "--remote-debugging-pipe", "about:blank", nullptr);
        ::_exit(127);
    }
    ::close(toBrowser[0]);
    ::close(fromBrowser[1]);
    std::unique_ptr<Browser> browser(new Browser());
    browser->m_process = process;
    browser->m_out = toBrowser[1];
    browser->m_in = fromBrowser[0];
    std::signal(SIGPIPE, SIG_IGN);
    const json target = browser->call("Target.createTarget", {{"url", "about:blank"}});
    if (target.contains("targetId")) {
        const json attached = browser->call("Target.attachToTarget", {{"targetId", target["targetId"]}, {"flatten", true}});
        if (attached.contains("sessionId")) browser->m_session = attached["sessionId"];
    }
    if (browser->m_session.empty()) {
        reason = program + " does not answer on its debugging pipe";
        return nullptr;
    }
    for (const char* domain : {"Page.enable", "Runtime.enable", "Network.enable", "Log.enable"}) browser->call(domain);
    return browser;
}

Browser::~Browser() {
    if (m_process > 0) {
        m_session.clear();
        call("Browser.close");
        ::close(m_out);
        ::close(m_in);
        // Chromium's child processes share its process group.
        for (int i = 0; i < 50; ++i) {
            if (::waitpid(m_process, nullptr, WNOHANG) == m_process) return;
            ::usleep(100000);
        }
        ::kill(-m_process, SIGKILL);
        ::waitpid(m_process, nullptr, 0);
    }
}

bool Browser::read(json& message, int milliseconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
    while (true) {
        if (const size_t zero = m_buffer.find('\0'); zero != std::string::npos) {
            message = json::parse(m_buffer.substr(0, zero), nullptr, false);
            m_buffer.erase(0, zero + 1);
            return !message.is_discarded();
        }
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
        pollfd waiting{m_in, POLLIN, 0};
        if (left <= 0 || ::poll(&waiting, 1, int(left)) <= 0) return false;
        char bytes[65536];
        const ssize_t count = ::read(m_in, bytes, sizeof bytes);
        if (count <= 0) return false;
        m_buffer.append(bytes, size_t(count));
    }
}

void Browser::hear(const json& message) {
    const std::string method = message.value("method", "");
    const json& parameters = message.contains("params") ? message["params"] : json::object();
    if (method == "Page.loadEventFired") m_loaded = true;
    if (method == "Runtime.exceptionThrown") m_errors.push_back(parameters["exceptionDetails"].dump().substr(0, 400));
    if (method == "Log.entryAdded" && parameters["entry"].value("level", "") == "error")
        m_errors.push_back(parameters["entry"].value("text", ""));
    if (method == "Network.requestWillBeSent") {
        const std::string url = parameters["request"].value("url", "");
        if (!url.starts_with("data:") && parameters.value("type", "") != "Document") m_requests.push_back(url);
    }
}

json Browser::call(const std::string& method, json parameters) {
    const int id = m_next++;
    json request = {{"id", id}, {"method", method}, {"params", std::move(parameters)}};
    if (!m_session.empty()) request["sessionId"] = m_session;
    const std::string text = request.dump() + '\0';
    for (size_t sent = 0; sent < text.size();) {
        const ssize_t count = ::write(m_out, text.data() + sent, text.size() - sent);
        if (count <= 0) return json::object();
        sent += size_t(count);
    }
    json message;
    while (read(message, kPatience)) {
        if (message.value("id", 0) == id) return message.value("result", json::object());
        hear(message);
    }
    return json::object();
}

bool Browser::open(const std::string& url, int width, int height, bool dark) {
    call("Emulation.setDeviceMetricsOverride", {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
    call("Emulation.setEmulatedMedia",
        {{"features", json::array({{{"name", "prefers-color-scheme"}, {"value", dark ? "dark" : "light"}}})}});
    m_loaded = false;
    call("Page.navigate", {{"url", url}});
    json message;
    while (!m_loaded && read(message, kPatience)) hear(message);
    return m_loaded;
}

json Browser::evaluate(const std::string& expression) {
    const json result = call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
    if (result.contains("exceptionDetails")) m_errors.push_back(result["exceptionDetails"].dump().substr(0, 400));
    return result.contains("result") ? result["result"].value("value", json()) : json();
}

void Browser::mouse(const char* type, double x, double y, int buttons) {
    call("Input.dispatchMouseEvent",
        {{"type", type}, {"x", x}, {"y", y}, {"button", std::string_view(type) == "mouseMoved" && !buttons ? "none" : "left"},
            {"buttons", buttons}, {"clickCount", 1}});
}
void Browser::click(double x, double y) { drag(x, y, x, y); }
void Browser::drag(double x0, double y0, double x1, double y1) {
    mouse("mouseMoved", x0, y0, 0);
    mouse("mousePressed", x0, y0, 1);
    for (int i = 1; i <= 8 && (x0 != x1 || y0 != y1); ++i) mouse("mouseMoved", x0 + (x1 - x0) * i / 8, y0 + (y1 - y0) * i / 8, 1);
    mouse("mouseReleased", x1, y1, 0);
}

void Browser::key(const std::string& name, int code) {
    for (const char* type : {"rawKeyDown", "keyUp"})
        call("Input.dispatchKeyEvent", {{"type", type}, {"key", name}, {"code", name}, {"windowsVirtualKeyCode", code}});
}

std::vector<std::byte> Browser::screenshot() { return fromBase64(call("Page.captureScreenshot", {{"format", "png"}}).value("data", "")); }

}  // namespace obscura::evaluate
