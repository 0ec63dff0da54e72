// glTF 2.0 loader. tinygltf parses; what it does not check is validated here: cycles, ranges, counts, NaN, paths outside the folder. Reads
// both containers, embedded and external buffers, sparse and normalized accessors, Draco and meshopt compression. runtime/scene/README.md
// lists the extensions.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>

#include "scene/model.h"

namespace obscura::scene {

// what() is one line: file, JSON pointer, what is wrong, what would be right.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct LoadOptions {
    int scene = -1;                     // -1: the file's default scene
    bool loadImages = true;             // false: images are 1x1 white, for tools that need geometry only
    size_t maxBytes = size_t(4) << 30;  // limit of all decoded data
};

// Throws Error. Never reads outside the file's folder.
std::shared_ptr<const Model> loadGltf(const std::filesystem::path& file, const LoadOptions& options = {});

// The same from memory, either container. `name` is the file name in errors. Reads data URIs and the BIN chunk; URIs of files are refused.
std::shared_ptr<const Model> loadGltfMemory(std::span<const uint8_t> bytes, const std::string& name, const LoadOptions& options = {});

}  // namespace obscura::scene
