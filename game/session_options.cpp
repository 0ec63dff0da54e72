// The session's state as options of the command line: those that the next start takes over, and those that draw the present frame.
#include <cmath>

#include <fmt/format.h>

#include "ao/settings_text.h"
#include "app/voxel_arguments.h"
#include "session.h"

namespace obscura::game {

namespace {

std::string text(const glm::vec3& v) { return fmt::format("{:.5g},{:.5g},{:.5g}", v.x, v.y, v.z); }

}  // namespace

// Values that are the default are left out.
std::vector<Argument> Session::settings() const {
    const Options plain;
    std::vector<Argument> list;
    if (!usesRecommendation()) list = methodOptions(choice.values());
    const auto add = [&](const char* option, const auto& value, const auto& initial) {
        if (value != initial) list.push_back({option, fmt::format("{:.5g}", value)});
    };
    const auto addName = [&](const char* option, const auto& value, const auto& initial, const auto& names) {
        if (value != initial) list.push_back({option, names[size_t(value)]});
    };
    if (ao::falloffText(choice.falloff) != ao::falloffText(plain.choice.falloff))
        list.push_back({"--falloff", ao::falloffText(choice.falloff)});
    if (bentNormals) list.push_back({"--bent-normals", ""});
    if (antialiasing == render::Antialiasing::none) list.push_back({"--aa", "none"});
    add("--exposure", exposure / stage.info.exposure, plain.exposure);
    add("--guard", guard, plain.guard);
    if (voxels.cells != plain.voxels.cells) list.push_back({"--voxels", std::to_string(voxels.cells)});
    if (voxels.levels != plain.voxels.levels) list.push_back({"--voxel-levels", std::to_string(voxels.levels)});
    addName("--voxelizer", voxels.voxelizer, plain.voxels.voxelizer, app::kVoxelizerNames);
    addName("--voxel-structure", voxels.structure, plain.voxels.structure, app::kStructureNames);
    addName("--voxel-shell", voxels.shell, plain.voxels.shell, app::kShellNames);
    if (options.budget) list.push_back({"--budget", fmt::format("{:g}", *options.budget)});
    if (options.uiScale) list.push_back({"--ui-scale", fmt::format("{:g}", *options.uiScale)});
    return list;
}

std::string Session::command(VkExtent2D size) const {
    std::vector<Argument> list{{"--scene", options.scene}, {"--size", fmt::format("{}x{}", size.width, size.height)},
        {"--eye", text(m_camera.eye)}, {"--target", text(m_camera.target)}, {"--fov", fmt::format("{:.4g}", glm::degrees(m_camera.fovY))}};
    if (time != 0.0f) list.push_back({"--time", fmt::format("{:.5g}", time)});
    if (options.animation != "all") list.push_back({"--animation", options.animation});
    if (options.bare) list.push_back({"--bare", ""});
    if (options.skipMasked) list.push_back({"--skip-masked", ""});
    if (stage.toys->dropped()) list.push_back({"--toys", std::to_string(stage.toys->dropped())});
    if (view != render::View::final)
        list.push_back({"--view", view == render::View::pass ? "pass:" + passView : std::string(render::name(view))});
    if (usesRecommendation())
        for (Argument& argument : methodOptions(choice.values())) list.push_back(std::move(argument));
    for (Argument& argument : settings()) list.push_back(std::move(argument));
    if (comparing) {
        list.push_back({"--compare", compareText(other.values())});
        list.push_back({"--split", fmt::format("{:.3f}", split)});
    }
    list.push_back({"--no-settings", ""});
    return "obscura " + asText(list);
}

}  // namespace obscura::game
