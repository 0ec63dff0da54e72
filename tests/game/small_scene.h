// A scene of a floor and a box that moves, small enough to be drawn in no time.
#pragma once

#include <filesystem>

namespace obscura::test {

// Writes small.gltf and small.bin into the folder; returns the path of the first. `scale` multiplies all lengths.
std::filesystem::path writeSmallScene(const std::filesystem::path& folder, float scale = 1.0f);

}  // namespace obscura::test
