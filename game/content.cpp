#include "content.h"

#include <cstdlib>

#include "app/complaint.h"
#include "app/files.h"
#include "scene/json_file.h"

namespace obscura::game {

namespace fs = std::filesystem;

std::vector<fs::path> contentFolders() {
    std::vector<fs::path> folders;
    std::error_code ignored;
    const auto add = [&](const fs::path& folder) {
        if (fs::is_directory(folder, ignored)) folders.push_back(folder);
    };
    const fs::path source = OBSCURA_SOURCE_DIR;
    add(source / "content");
    if (const fs::path program = app::executableFolder(); !program.empty()) add((program / "../share/obscura").lexically_normal());
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

namespace {

float numberOr(const scene::JsonAt& at, const char* key, float otherwise) {
    const auto found = at.find(key);
    return found ? float(found->number()) : otherwise;
}

glm::vec2 vector2(const scene::JsonAt& at) {
    at.expectNumbers(2);
    return {float(at.at(size_t(0)).number()), float(at.at(size_t(1)).number())};
}

SceneInfo sceneOf(const scene::JsonAt& at) {
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

std::vector<SceneInfo> loadManifest() {
    const auto file = findContent("scenes.json");
    if (!file) throw app::Complaint("scenes.json: not found in content/ or ../share/obscura; run from the source tree or an installation");
    const scene::JsonFile json(*file);
    const scene::JsonAt scenes = json.root().at("scenes").expectArray();
    std::vector<SceneInfo> list;
    for (size_t i = 0; i < scenes.size(); ++i) list.push_back(sceneOf(scenes.at(i)));
    return list;
}

}  // namespace obscura::game
