// Float pictures in memory and as OpenEXR files. Rows run top to bottom.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf.h"  // scene::Error

namespace obscura::truth {

// One number a pixel.
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

    const Channel* find(std::string_view name) const;  // null when there is none
    Plane plane(std::string_view name) const;          // throws scene::Error that lists the channels there are
    void add(std::string name, Plane plane);           // asserts the size; the first one decides it
};

// Reads a single-part file of scan lines; half and float channels become float. With `names`, exactly those are
// asked for and given, in that order. Throws scene::Error, one line: file, what is wrong (not there, no EXR, truncated,
// too large, channel missing), what to do.
Picture readExr(const std::filesystem::path& file, std::initializer_list<std::string_view> names = {});

// float32, ZIP-compressed, to a temporary name and then renamed: on failure (scene::Error) nothing is left behind and an
// older file stays as it was.
void writeExr(const std::filesystem::path& file, const Picture& picture);

// Any file in the same way.
void writeWhole(const std::filesystem::path& file, const void* bytes, size_t count);

}  // namespace obscura::truth
