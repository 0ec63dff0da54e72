// A generated scene with a given number of triangles, for scaling tests: 64 balls on a floor in front of a wall.
#pragma once

#include <cstdint>
#include <filesystem>

namespace obscura::bench {

// Writes balls-N.glb, N = `triangles`, to the folder; returns its path. The number of triangles is approximate.
std::filesystem::path writeBalls(uint64_t triangles, const std::filesystem::path& folder);

}  // namespace obscura::bench
