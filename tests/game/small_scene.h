// A small scene: a floor and a moving box.
#pragma once

#include <filesystem>

namespace obscura::test {

// Writes small.gltf and small.bin into the folder; returns the path of small.gltf. `scale` multiplies all lengths.
std::filesystem::path writeSmallScene(const std::filesystem::path& folder, float scale = 1.0f);

}  // namespace obscura::test
