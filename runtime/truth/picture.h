// Float images in memory and as OpenEXR files. Rows top to bottom.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf/gltf.h"  // scene::Error

namespace obscura::truth {

// One float per pixel.
struct Plane {
    uint32_t width = 0, height = 0;
    std::vector<float> values;  // width * height

    Plane() = default;
    Plane(uint32_t w, uint32_t h, float value = 0.0f) : width(w), height(h), values(size_t(w) * h, value) {}
    size_t pixels() const { return values.size(); }
    float& at(uint32_t x, uint32_t y) { return values[size_t(y) * width + x]; }
    float at(uint32_t x, uint32_t y) const { return values[size_t(y) * width + x]; }
};

// Named planes of one size.
struct Picture {
    struct Channel {
        std::string name;           // "Z", "N.X", "world.quadratic_2"
        std::vector<float> values;  // width * height
    };
    uint32_t width = 0, height = 0;
    std::vector<Channel> channels;

    const Channel* find(std::string_view name) const;  // null if missing
    Plane plane(std::string_view name) const;          // throws scene::Error, which lists the channels, if missing
    void add(std::string name, Plane plane);           // asserts that the size is that of the first plane
};

// Reads a single-part scan-line file; half and float channels become float. With `names`, returns these channels in this order, else all.
// Throws scene::Error, one line: file, what is wrong (missing, not an EXR, truncated, too large, channel missing), what would be right.
Picture readExr(const std::filesystem::path& file, std::initializer_list<std::string_view> names = {});

// float32, ZIP-compressed. Written to a temporary name, then renamed: on failure (scene::Error) an older file is unchanged.
void writeExr(const std::filesystem::path& file, const Picture& picture);

// Writes bytes in the same way.
void writeWhole(const std::filesystem::path& file, const void* bytes, size_t count);

}  // namespace obscura::truth
