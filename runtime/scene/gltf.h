// glTF 2.0 in, Model out. tinygltf parses; everything it lets through (loops, ranges, counts, NaN, paths that leave the
// folder) is checked here. Both containers, embedded and external buffers, sparse and normalized accessors, Draco and
// meshopt compression; see README.md of this folder for the extensions understood.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>

#include "scene/model.h"

namespace obscura::scene {

// what() is one line: file, JSON pointer, what is wrong, what to do.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct LoadOptions {
    int scene = -1;              // -1: the file's default scene
    bool loadImages = true;      // false leaves images empty (1x1 white), for tools that need geometry only
    size_t maxBytes = size_t(4) << 30;  // refuses files whose decoded data would pass this
};

// Throws Error. Never reads outside the file's folder.
std::shared_ptr<const Model> loadGltf(const std::filesystem::path& file, const LoadOptions& options = {});

// The same from memory, either container. `name` stands for the file in errors. Data URIs and the BIN chunk are read,
// anything that refers to a file is refused.
std::shared_ptr<const Model> loadGltfMemory(std::span<const uint8_t> bytes, const std::string& name, const LoadOptions& options = {});

}  // namespace obscura::scene
