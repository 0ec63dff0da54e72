#include "app/files.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include <fmt/format.h>
#include <unistd.h>

#include "app/complaint.h"

namespace obscura::app {

namespace fs = std::filesystem;

namespace {

fs::path temporaryName(const fs::path& file) {
    return file.parent_path() / fmt::format(".{}.{}.part", file.filename().string(), ::getpid());
}

[[noreturn]] void refuse(const fs::path& file, const char* why) {
    throw Complaint(fmt::format("{}: cannot be written ({}); choose a folder that exists and is writable", file.string(), why));
}

}  // namespace

void writeFile(const fs::path& file, std::span<const std::byte> bytes) {
    const fs::path temporary = temporaryName(file);
    std::FILE* out = std::fopen(temporary.c_str(), "wb");
    if (!out) refuse(file, std::strerror(errno));
    errno = 0;
    bool written = bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size();
    written = std::fflush(out) == 0 && written;
    int reason = errno;
    written = std::fclose(out) == 0 && written;
    if (written && std::rename(temporary.c_str(), file.c_str()) == 0) return;
    if (written) reason = errno;
    std::remove(temporary.c_str());
    refuse(file, std::strerror(reason));
}

void writeFile(const fs::path& file, std::string_view text) { writeFile(file, std::as_bytes(std::span(text))); }

void expectWritable(const fs::path& file) {
    if (file.filename().empty() || fs::is_directory(file)) refuse(file, "it is a folder");
    const fs::path probe = temporaryName(file);
    std::FILE* out = std::fopen(probe.c_str(), "wb");
    if (!out) refuse(file, std::strerror(errno));
    std::fclose(out);
    std::remove(probe.c_str());
}

void expectFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) refuse(folder, error.message().c_str());
    expectWritable(folder / "probe");
}

std::filesystem::path freshName(const std::string& stem, const std::string& extension) {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    ::localtime_r(&now, &local);
    char stamp[32];
    std::strftime(stamp, sizeof(stamp), "%Y%m%d-%H%M%S", &local);
    fs::path name = fmt::format("{}-{}{}", stem, stamp, extension);
    for (int i = 2; fs::exists(name); ++i) name = fmt::format("{}-{}-{}{}", stem, stamp, i, extension);
    return name;
}

std::string base64(std::span<const std::byte> bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t left = bytes.size() - i;
        uint32_t word = uint32_t(bytes[i]) << 16;
        if (left > 1) word |= uint32_t(bytes[i + 1]) << 8;
        if (left > 2) word |= uint32_t(bytes[i + 2]);
        text += kDigits[word >> 18 & 63];
        text += kDigits[word >> 12 & 63];
        text += left > 1 ? kDigits[word >> 6 & 63] : '=';
        text += left > 2 ? kDigits[word & 63] : '=';
    }
    return text;
}

fs::path executableFolder() {
    std::error_code error;
    const fs::path self = fs::read_symlink("/proc/self/exe", error);
    return error ? fs::path() : self.parent_path();
}

fs::path cacheFolder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return fs::path(cache) / "obscura";
    if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "obscura";
    return {};
}

}  // namespace obscura::app
