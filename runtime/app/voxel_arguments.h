// Command-line options of voxelization, the same in every program.
#pragma once

#include <string>

#include "render/voxel_volume.h"

namespace CLI {
class App;
}

namespace obscura::app {

// Adds --voxels, --voxel-levels, --voxel-size, --voxelizer, --voxel-structure and --voxel-shell to a group of `cli`; parsing fills
// `into`. Also sets `into.building` to a progress bar.
void addVoxelArguments(CLI::App& cli, render::Voxelization& into, const std::string& group);

inline constexpr const char* kVoxelizerNames[] = {"openvdb", "gpu"};
inline constexpr const char* kStructureNames[] = {"dense", "nanovdb"};
inline constexpr const char* kShellNames[] = {"conservative", "thin"};

}  // namespace obscura::app
