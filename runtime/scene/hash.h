// Content hashes: the names of cached files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

namespace obscura::scene {

// 128-bit hash of the values added, in order. Not cryptographic.
class Hash {
public:
    Hash& add(const void* bytes, size_t count);
    Hash& add(std::string_view text);  // its length too
    template <class T>
        requires std::is_arithmetic_v<T>
    Hash& add(T value) {
        return add(&value, sizeof value);
    }
    std::string hex() const;  // 32 digits

private:
    void word(uint64_t value);
    uint64_t m_a = 0x243f6a8885a308d3ull, m_b = 0x13198a2e03707344ull, m_words = 0;
};

// Folder of cached files: $OBSCURA_CACHE, else $XDG_CACHE_HOME/obscura, else $HOME/.cache/obscura, else empty. OBSCURA_CACHE="" turns the
// cache off.
std::filesystem::path cacheFolder();

}  // namespace obscura::scene
