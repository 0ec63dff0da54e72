// An 8-bit image in host memory, and PNG output.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace obscura::app {

struct Picture {
    uint32_t width = 0, height = 0;  // px
    std::vector<uint8_t> rgba;       // rows top to bottom, sRGB-encoded, tightly packed
    Picture half() const;            // box-filtered to half the size, for thumbnails
};

// Opaque RGB; deterministic.
std::vector<std::byte> encodePng(const Picture& picture);
// Atomic, as writeFile(); throws Complaint.
void writePng(const std::filesystem::path& file, const Picture& picture);

}  // namespace obscura::app
