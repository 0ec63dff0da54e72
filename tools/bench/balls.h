// A scene of any number of triangles that always shows the same: sixty-four balls on a floor before a wall.
#pragma once

#include <cstdint>
#include <filesystem>

namespace obscura::bench {

// Writes balls-N.glb to the folder, N close to `triangles`; returns its path.
std::filesystem::path writeBalls(uint64_t triangles, const std::filesystem::path& folder);

}  // namespace obscura::bench
