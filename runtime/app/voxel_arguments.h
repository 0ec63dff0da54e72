// How the world is voxelized, as command-line options: the same for every program.
#pragma once

#include <string>

#include "render/voxel_volume.h"

namespace CLI {
class App;
}

namespace obscura::app {

// Adds --voxels, --voxel-size, --voxelizer, --voxel-structure and --voxel-shell to a group of `cli`, which fills `into` when it parses; and a progress bar
// for what takes long.
void addVoxelArguments(CLI::App& cli, render::Voxelization& into, const std::string& group);

inline constexpr const char* kVoxelizerNames[] = {"openvdb", "gpu"};
inline constexpr const char* kStructureNames[] = {"dense", "nanovdb"};
inline constexpr const char* kShellNames[] = {"conservative", "thin"};

}  // namespace obscura::app
