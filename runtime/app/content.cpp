#include "app/content.h"

#include <cstdlib>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"
#include "scene/json_file.h"

namespace obscura::app {

namespace fs = std::filesystem;

std::vector<fs::path> contentFolders() {
    std::vector<fs::path> folders;
    std::error_code ignored;
    const auto add = [&](const fs::path& folder) {
        if (fs::is_directory(folder, ignored)) folders.push_back(folder);
    };
    const fs::path source = OBSCURA_SOURCE_DIR;
    add(source / "content");
    if (const fs::path program = executableFolder(); !program.empty()) add((program / "../share/obscura").lexically_normal());
    if (const char* named = std::getenv("OBSCURA_CONTENT"); named && *named) add(named);
    add((source / "../shared/content").lexically_normal());
    return folders;
}

std::optional<fs::path> findContent(const std::vector<std::string>& relatives) {
    std::error_code ignored;
    for (const fs::path& folder : contentFolders())
        for (const std::string& relative : relatives)
            if (fs::is_regular_file(folder / relative, ignored)) return folder / relative;
    return std::nullopt;
}

std::optional<fs::path> findContent(const std::string& relative) { return findContent(std::vector{relative}); }

fs::path expectContent(const std::string& relative) {
    if (const auto found = findContent(relative)) return *found;
    throw Complaint(
        fmt::format("{}: not found in content/ or ../share/obscura; run from the source tree or an installation, or name a "
                    "content folder in OBSCURA_CONTENT",
            relative));
}

namespace {

float numberOr(const scene::JsonAt& at, const char* key, float otherwise) {
    const auto found = at.find(key);
    return found ? float(found->number()) : otherwise;
}

glm::vec2 vector2(const scene::JsonAt& at) {
    at.expectNumbers(2);
    return {float(at.at(size_t(0)).number()), float(at.at(size_t(1)).number())};
}

SceneInfo infoOf(const scene::JsonAt& at) {
    at.only({"name", "title", "files", "howToGet", "flythrough", "floor", "eye", "target", "walk", "exposure", "toyScale", "toys"});
    SceneInfo info;
    info.name = at.at("name").text();
    info.title = at.at("title").text();
    const scene::JsonAt files = at.at("files").expectArray();
    for (size_t i = 0; i < files.size(); ++i) info.files.push_back(files.at(i).text());
    info.howToGet = at.at("howToGet").text();
    info.flythrough = at.at("flythrough").text();
    info.floor = numberOr(at, "floor", 0.0f);
    info.eye = scene::vector3(at.at("eye"));
    info.target = scene::vector3(at.at("target"));
    if (const auto walk = at.find("walk")) {
        walk->only({"min", "max"});
        info.walkMin = vector2(walk->at("min"));
        info.walkMax = vector2(walk->at("max"));
    }
    info.exposure = numberOr(at, "exposure", 1.0f);
    info.toyScale = numberOr(at, "toyScale", 1.0f);
    if (const auto toys = at.find("toys")) {
        toys->expectArray();
        for (size_t i = 0; i < toys->size(); ++i) {
            const scene::JsonAt toy = toys->at(i);
            toy.only({"at", "turnDegrees", "scale", "time"});
            info.toys.push_back({scene::vector3(toy.at("at")), glm::radians(numberOr(toy, "turnDegrees", 0.0f)),
                numberOr(toy, "scale", info.toyScale), numberOr(toy, "time", 0.0f)});
        }
    }
    return info;
}

}  // namespace

std::optional<scene::Camera> SceneFile::camera() const {
    if (!named) return std::nullopt;
    scene::Camera camera;
    camera.eye = info.eye;
    camera.target = info.target;
    return camera;
}

std::vector<SceneFile> namedScenes() {
    const scene::JsonFile json(expectContent("scenes.json"));
    const scene::JsonAt scenes = json.root().at("scenes").expectArray();
    std::vector<SceneFile> list;
    for (size_t i = 0; i < scenes.size(); ++i) {
        SceneFile& scene = list.emplace_back();
        scene.info = infoOf(scenes.at(i));
        scene.named = true;
        scene.file = findContent(scene.info.files).value_or(fs::path());
        scene.flythrough = findContent(scene.info.flythrough);
    }
    return list;
}

SceneFile findScene(const std::string& nameOrPath) {
    std::vector<std::string> names;
    for (SceneFile& scene : namedScenes()) {
        if (scene.info.name == nameOrPath) return scene;
        names.push_back(scene.info.name);
    }
    std::error_code ignored;
    if (fs::is_regular_file(nameOrPath, ignored)) {
        SceneFile scene;
        scene.info.name = fs::path(nameOrPath).stem().string();
        scene.file = nameOrPath;
        return scene;
    }
    const bool path = nameOrPath.find('/') != std::string::npos || nameOrPath.find(".gl") != std::string::npos;
    throw Complaint(path
                        ? fmt::format("--scene {}: no such file; name a .gltf or .glb file, or one of the scenes: {}", nameOrPath,
                              fmt::join(names, ", "))
                        : fmt::format("--scene {}: no such scene; {}, or the path of a glTF file", nameOrPath, choices(nameOrPath, names)));
}

SceneFile expectScene(const std::string& nameOrPath) {
    SceneFile scene = findScene(nameOrPath);
    if (scene.file.empty()) throw Complaint(fmt::format("--scene {}: its file is missing; {}", scene.info.name, scene.info.howToGet));
    return scene;
}

}  // namespace obscura::app
