#include "app/voxel_arguments.h"

#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "app/progress.h"

namespace obscura::app {
namespace {

// Adds an option that takes the names of an enum's values.
template <class Enum, size_t count>
CLI::Option* addNamed(CLI::App& cli, const char* option, Enum& into, const char* const (&names)[count], const char* sentence) {
    const auto set = [&into, &names](const std::string& text) {
        for (size_t i = 0; i < count; ++i)
            if (text == names[i]) into = Enum(i);
    };
    return cli.add_option_function<std::string>(option, set, sentence)
        ->check(CLI::IsMember(std::vector<std::string>(names, names + count)))
        ->default_str(names[size_t(into)]);
}

constexpr size_t kBarSteps = 100;

// A progress bar that is shown while voxels are being built.
std::function<void(float)> bar() {
    auto shown = std::make_shared<std::optional<Progress>>();
    return [shown](float done) {
        if (!*shown && done < 1.0f) shown->emplace("voxels, %", kBarSteps);
        if (done < 1.0f) (*shown)->at(size_t(done * float(kBarSteps)));
        else shown->reset();
    };
}

}  // namespace

void addVoxelArguments(CLI::App& cli, render::Voxelization& into, const std::string& group) {
    cli.add_option("--voxels", into.cells,
           "Cells per side of each level of voxels around the camera, for methods that trace voxels; 2 MiB a level at 256, 8 times that at "
           "512")
        ->group(group)
        ->check(CLI::IsMember({64u, 128u, 256u, 512u}))
        ->capture_default_str();
    cli.add_option("--voxel-levels", into.levels,
           "Levels of voxels, each twice as wide as the one before, with cells twice as large. Nothing beyond the last one occludes")
        ->group(group)
        ->check(CLI::Range(1u, voxel::kMostLevels))
        ->capture_default_str();
    cli.add_option("--voxel-size", into.cellSize,
           "Side of the finest cells in metres; 0: 18 m / --voxels, less in scenes that fit into the finest level. Larger cells darken "
           "open "
           "places")
        ->group(group)
        ->check(CLI::Range(0.0f, 1000.0f))
        ->capture_default_str();
    addNamed(cli, "--voxelizer", into.voxelizer, kVoxelizerNames,
        "openvdb: static geometry once (cached on disk), objects only when they move, on the CPU; gpu: everything, every frame")
        ->group(group);
    addNamed(cli, "--voxel-structure", into.structure, kStructureNames,
        "dense: one bit per cell; nanovdb: the same cells as a sparse grid, which takes less memory and is slower to trace")
        ->group(group);
    addNamed(cli, "--voxel-shell", into.shell, kShellNames,
        "conservative: every cell that a triangle touches; thin: only enough cells that no path over cell faces crosses a surface")
        ->group(group);
    into.building = bar();
}

}  // namespace obscura::app
