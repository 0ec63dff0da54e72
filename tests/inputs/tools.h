// Runs every program that draws scenes on unusual inputs, which tests build.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "../shell.h"
#include "../temporary_folder.h"
#include "scene/gltf_builder.h"

namespace obscura::test {

using scene::test::GltfBuilder;
using scene::test::Json;
namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& bytes);
std::string textOf(const fs::path& file);

// A floor of 8 m x 8 m at height 0 and a block of 1 m on it, each a node with a mesh of its own; all lengths times `scale`.
GltfBuilder roomScene(float scale = 1.0f);

}  // namespace obscura::test
