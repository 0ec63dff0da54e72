#include "app/voxel_arguments.h"

#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "app/progress.h"

namespace obscura::app {
namespace {

// An option that takes the names of an enum's values.
template <class Enum, size_t count>
CLI::Option* addNamed(CLI::App& cli, const char* option, Enum& into, const char* const (&names)[count], const char* sentence) {
    const auto set = [&into, &names](const std::string& text) {
        for (size_t i = 0; i < count; ++i)
            if (text == names[i]) into = Enum(i);
    };
    return cli.add_option_function<std::string>(option, set, sentence)->check(CLI::IsMember(std::vector<std::string>(names, names + count)))->default_str(names[size_t(into)]);
}

constexpr size_t kParts = 100;

// A bar from the first look at an unfinished build to its end.
std::function<void(float)> bar() {
    auto shown = std::make_shared<std::optional<Progress>>();
    return [shown](float done) {
        if (!*shown && done < 1.0f) shown->emplace("voxels, %", kParts);
        if (done < 1.0f) (*shown)->at(size_t(done * float(kParts)));
        else shown->reset();
    };
}

}  // namespace

void addVoxelArguments(CLI::App& cli, render::Voxelization& into, const std::string& group) {
    cli.add_option("--voxels", into.cells, "Cells a side of the voxel window, for methods that trace voxels")
        ->group(group)->check(CLI::IsMember({64u, 128u, 256u, 512u}))->capture_default_str();
    cli.add_option("--voxel-size", into.cellSize, "Metres a cell; 0: the scene's longest side fills the window, at most 0.14")
        ->group(group)->check(CLI::Range(0.0f, 1000.0f))->capture_default_str();
    addNamed(cli, "--voxelizer", into.voxelizer, kVoxelizerNames, "openvdb: what rests is made once and kept, objects are redone as they move; gpu: all, every frame")->group(group);
    addNamed(cli, "--voxel-structure", into.structure, kStructureNames, "dense: a window of bits around the camera; nanovdb: all of the world as a sparse grid, slower to trace")->group(group);
    addNamed(cli, "--voxel-shell", into.shell, kShellNames, "conservative: each cell that a surface touches; thin: as few as stop a path over cell faces")->group(group);
    into.building = bar();
}

}  // namespace obscura::app
