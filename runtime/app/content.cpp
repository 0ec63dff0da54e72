#include "app/content.h"

#include <algorithm>
#include <cstdlib>
#include <map>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "app/complaint.h"
#include "app/files.h"
#include "scene/json_file.h"
#include "scene/json_text.h"

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
        SceneFile found;
        found.info.name = scene::utf8(fs::path(nameOrPath).stem().string());
        found.file = nameOrPath;
        return found;
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

namespace {

// Ever longer names of a file: "hall", "hall.glb", "before-hall.glb", "old-before-hall.glb".
std::string longerName(const SceneFile& scene, size_t parts) {
    if (scene.named || parts == 0) return scene.info.name;
    const fs::path path = fs::absolute(scene.file).lexically_normal();
    std::string name = path.filename().string();
    fs::path folder = path.parent_path();
    for (size_t i = 1; i < parts && folder.has_filename(); ++i, folder = folder.parent_path())
        name = folder.filename().string() + "-" + name;
    return scene::utf8(name);
}

}  // namespace

std::vector<SceneFile> expectScenes(const std::vector<std::string>& namesOrPaths) {
    std::vector<SceneFile> scenes;
    for (const std::string& name : namesOrPaths) scenes.push_back(expectScene(name));
    for (size_t i = 0; i < scenes.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            if (std::error_code ignored; fs::equivalent(scenes[i].file, scenes[j].file, ignored))
                throw Complaint(fmt::format("--scene {}: is named twice; leave one out", namesOrPaths[i]));
    const std::vector<SceneFile> given = scenes;
    std::vector<size_t> parts(scenes.size(), 0);
    for (bool all = false; !all;) {
        all = true;
        for (size_t i = 0; i < scenes.size(); ++i) scenes[i].info.name = longerName(given[i], parts[i]);
        std::map<std::string, size_t> uses;
        for (const SceneFile& scene : scenes) ++uses[scene.info.name];
        for (size_t i = 0; i < scenes.size(); ++i) {
            const std::string next = longerName(given[i], parts[i] + 1);
            if (uses[scenes[i].info.name] < 2 || next == scenes[i].info.name) continue;
            ++parts[i];
            all = false;
        }
    }
    return scenes;
}

namespace {

std::string nameOr(const std::string& name, const char* kind, size_t index) {
    return name.empty() ? fmt::format("{} {}", kind, index) : scene::utf8(name);
}

}  // namespace

int animationOf(const scene::Model& model, const std::string& name) {
    if (name == "all") return scene::kAllAnimations;
    if (name == "none") return scene::kRestPose;
    std::vector<std::string> names{"all", "none"};
    for (size_t i = 0; i < model.animations.size(); ++i) {
        if (model.animations[i].name == name || std::to_string(i) == name) return int(i);
        names.push_back(nameOr(model.animations[i].name, "animation", i));
    }
    throw Complaint(fmt::format("--animation {}: {} has no such animation; {}", name, model.name, choices(name, names)));
}

std::string contentList(const scene::Model& model) {
    std::string text = fmt::format("{}: {} nodes, {} triangles\n", scene::utf8(model.name), model.order.size(), model.triangleCount());
    int camera = 0;
    for (const int node : model.order) {
        if (model.nodes[size_t(node)].camera < 0) continue;
        const size_t index = size_t(model.nodes[size_t(node)].camera);
        const scene::Lens& lens = model.lenses[index];
        const std::string range =
            lens.farPlane > 0.0f ? fmt::format("{:g} to {:g}", lens.nearPlane, lens.farPlane) : fmt::format("from {:g} on", lens.nearPlane);
        text += fmt::format("camera     --camera scene:{}  {}, {}, {}\n", camera++, nameOr(lens.name, "camera", index),
            lens.perspective ? fmt::format("perspective, {:.1f} degrees high", glm::degrees(lens.fovY))
                             : fmt::format("orthographic, {:g} high", 2.0f * lens.halfHeight),
            range);
    }
    const std::vector<int> together = scene::playing(model, scene::kAllAnimations);
    for (size_t i = 0; i < model.animations.size(); ++i) {
        const bool plays = std::find(together.begin(), together.end(), int(i)) != together.end();
        text += fmt::format("animation  --animation {}  {}, {:g} s, {}\n", i, nameOr(model.animations[i].name, "animation", i),
            model.animations[i].duration, plays ? "plays" : "moves what an earlier one moves: plays if chosen");
    }
    for (const std::string& variant : model.variants)
        text += fmt::format("variant    {}: ignored, the default materials are shown\n", scene::utf8(variant));
    for (const scene::Extension& extension : model.extensions)
        text += fmt::format("extension  {}: {}\n", scene::utf8(extension.name), extension.read ? "read" : "ignored");
    for (const std::string& warning : model.warnings) text += fmt::format("remark     {}\n", scene::utf8(warning));
    return text;
}

PlacedScene loadScene(const SceneFile& file, const std::string& animation) {
    PlacedScene placed{{.model = scene::loadGltf(file.file)}, {}, {}};
    const scene::Model& model = *placed.instance.model;
    placed.instance.animation = animationOf(model, animation);
    placed.remarks = model.warnings;
    if (const size_t plays = scene::playing(model, placed.instance.animation).size(); animation == "all" && plays < model.animations.size())
        placed.remarks.push_back(fmt::format("{}: {} of {} animations play, since the others move the same nodes; --animation chooses one",
            file.file.string(), plays, model.animations.size()));
    const auto measure = [&] {
        scene::World world;
        world.add(placed.instance);
        placed.bounds = scene::bounds(world, 0.0f);
    };
    measure();
    if (placed.bounds.empty)
        throw Complaint(fmt::format("--scene {}: contains nothing to draw; it needs at least one triangle", file.file.string()));
    if (file.named) return placed;
    constexpr float kLargest = 120.0f, kSmallest = 0.25f;
    const float radius = placed.bounds.radius();
    float scale = 1.0f;
    while (radius * scale > kLargest) scale *= 0.1f;
    while (radius * scale < kSmallest && radius > 0.0f && scale < 1e9f) scale *= 10.0f;
    if (scale == 1.0f) return placed;
    placed.remarks.push_back(fmt::format("{}: {:g} m across, shown at {:g} times its size", file.file.string(), 2.0f * radius, scale));
    placed.instance.placement = glm::scale(glm::mat4(1.0f), glm::vec3(scale));
    measure();
    return placed;
}

}  // namespace obscura::app
