#include "scene/hash.h"

#include <bit>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

namespace obscura::scene {

void Hash::word(uint64_t value) {
    m_a = (std::rotl(m_a, 23) ^ value) * 0x9e3779b97f4a7c15ull;
    m_b = std::rotl(m_b + value * 0xc2b2ae3d27d4eb4full, 31) * 0x165667b19e3779f9ull;
    ++m_words;
}

Hash& Hash::add(const void* bytes, size_t count) {
    const auto* at = static_cast<const unsigned char*>(bytes);
    word(count);
    for (; count >= 8; count -= 8, at += 8) {
        uint64_t value;
        std::memcpy(&value, at, 8);
        word(value);
    }
    uint64_t rest = 0;
    if (count) std::memcpy(&rest, at, count), word(rest);
    return *this;
}

Hash& Hash::add(std::string_view text) { return add(text.data(), text.size()); }

std::string Hash::hex() const {
    const auto finish = [](uint64_t x) {
        x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdull;
        x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53ull;
        return x ^ (x >> 33);
    };
    return fmt::format("{:016x}{:016x}", finish(m_a ^ m_words), finish(m_b + m_a));
}

std::filesystem::path cacheFolder() {
    if (const char* own = std::getenv("OBSCURA_CACHE")) return own;
    if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg) return std::filesystem::path(xdg) / "obscura";
    if (const char* home = std::getenv("HOME"); home && *home) return std::filesystem::path(home) / ".cache" / "obscura";
    return {};
}

}  // namespace obscura::scene
