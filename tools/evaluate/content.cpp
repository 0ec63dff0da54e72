#include "content.h"

#include <cstdlib>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"
#include "scene/json_file.h"

namespace obscura::evaluate {

namespace fs = std::filesystem;
using app::Complaint;

namespace {

SceneFile sceneOf(const scene::JsonAt& at) {
    SceneFile scene;
    scene.name = at.at("name").text();
    scene.howToGet = at.at("howToGet").text();
    const scene::JsonAt files = at.at("files").expectArray();
    for (size_t i = 0; i < files.size() && scene.file.empty(); ++i)
        if (const auto found = findContent(files.at(i).text())) scene.file = *found;
    scene.flythrough = findContent(at.at("flythrough").text());
    scene.camera.emplace();
    scene.camera->eye = scene::vector3(at.at("eye"));
    scene.camera->target = scene::vector3(at.at("target"));
    return scene;
}

}  // namespace

std::optional<fs::path> findContent(const std::string& relative) {
    const fs::path source = OBSCURA_SOURCE_DIR;
    std::vector<fs::path> folders{source / "content"};
    if (const fs::path program = app::executableFolder(); !program.empty())
        folders.push_back((program / "../share/obscura").lexically_normal());
    if (const char* named = std::getenv("OBSCURA_CONTENT"); named && *named) folders.emplace_back(named);
    folders.push_back((source / "../shared/content").lexically_normal());
    std::error_code ignored;
    for (const fs::path& folder : folders)
        if (fs::is_regular_file(folder / relative, ignored)) return folder / relative;
    return std::nullopt;
}

std::vector<SceneFile> namedScenes() {
    const auto manifest = findContent("scenes.json");
    if (!manifest)
        throw Complaint("scenes.json: not found in content/; run from the source tree, or name a content folder in OBSCURA_CONTENT");
    const scene::JsonFile json(*manifest);
    const scene::JsonAt scenes = json.root().at("scenes").expectArray();
    std::vector<SceneFile> list;
    for (size_t i = 0; i < scenes.size(); ++i) list.push_back(sceneOf(scenes.at(i)));
    return list;
}

SceneFile findScene(const std::string& nameOrPath) {
    std::vector<std::string> names;
    for (SceneFile& scene : namedScenes()) {
        names.push_back(scene.name);
        if (scene.name != nameOrPath) continue;
        if (scene.file.empty()) throw Complaint(fmt::format("--scene {}: its file is missing; {}", scene.name, scene.howToGet));
        return scene;
    }
    std::error_code ignored;
    if (fs::is_regular_file(nameOrPath, ignored)) return {fs::path(nameOrPath).stem().string(), nameOrPath, {}, {}, {}};
    const bool path = nameOrPath.find('/') != std::string::npos || nameOrPath.find(".gl") != std::string::npos;
    throw Complaint(
        path ? fmt::format(
                   "--scene {}: no such file; name a .gltf or .glb file, or one of the scenes: {}", nameOrPath, fmt::join(names, ", "))
             : fmt::format("--scene {}: no such scene; {}, or the path of a glTF file", nameOrPath, app::choices(nameOrPath, names)));
}

}  // namespace obscura::evaluate
