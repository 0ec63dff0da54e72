// An 8-bit picture in host memory and its way into a PNG file.
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

// Opaque RGB; the same picture gives the same bytes.
std::vector<std::byte> encodePng(const Picture& picture);
// Whole or not at all; throws Complaint.
void writePng(const std::filesystem::path& file, const Picture& picture);

}  // namespace obscura::app
