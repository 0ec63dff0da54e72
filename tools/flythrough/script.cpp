#include "script.h"

#include <algorithm>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "app/arguments.h"
#include "app/complaint.h"
#include "app/content.h"
#include "measure/measurement.h"
#include "scene/json_file.h"
#include "scene/json_text.h"

namespace obscura::flythrough {

using app::Complaint;

namespace {

Event eventOf(const scene::JsonAt& at) {
    at.only({"frame", "box", "size", "at", "gone"});
    Event event;
    event.frame = uint32_t(at.at("frame").whole(0, 1u << 20));
    event.box = at.at("box").text();
    if (const auto gone = at.find("gone")) event.gone = gone->truth();
    if (event.gone) return event;
    event.size = scene::vector3(at.at("size"));
    event.at = scene::vector3(at.at("at"));
    if (glm::any(glm::lessThanEqual(event.size, glm::vec3(0.0f)))) at.at("size").fail("must be positive");
    return event;
}

Script scriptOf(const scene::JsonAt& at) {
    at.only({"name", "title", "scene", "camera", "path", "start", "framesPerSecond", "animated", "falloff", "events"});
    Script script;
    script.name = at.at("name").text();
    script.title = at.at("title").text();
    script.scene = at.at("scene").text();
    if (const auto camera = at.find("camera")) {
        camera->only({"eye", "target", "verticalFovDegrees"});
        script.camera.emplace();
        script.camera->eye = scene::vector3(camera->at("eye"));
        script.camera->target = scene::vector3(camera->at("target"));
        if (const auto fov = camera->find("verticalFovDegrees")) script.camera->fovY = scene::fieldOfView(*fov);
    } else {
        script.path = at.at("path").text();
    }
    if (const auto start = at.find("start")) script.start = float(start->number(0.0, 1e6));
    if (const auto rate = at.find("framesPerSecond")) script.framesPerSecond = float(rate->number(1.0, 1000.0));
    if (const auto animated = at.find("animated")) script.animated = animated->truth();
    if (const auto falloff = at.find("falloff")) script.falloff = falloff->text();
    if (const auto events = at.find("events")) {
        events->expectArray();
        for (size_t i = 0; i < events->size(); ++i) script.events.push_back(eventOf(events->at(i)));
        if (!std::is_sorted(script.events.begin(), script.events.end(), [](const Event& a, const Event& b) { return a.frame < b.frame; }))
            events->fail("must be in the order of their frames");
    }
    return script;
}

// A unit cube, 1 m, with face normals.
std::shared_ptr<const scene::Model> unitBox() {
    auto model = std::make_shared<scene::Model>();
    model->name = "box";
    scene::Material material;
    material.metallic = 0.0f;
    model->materials.push_back(material);
    scene::Primitive box;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {1.0f, -1.0f}) {
            glm::vec3 n(0.0f), t(0.0f);
            n[axis] = side;
            t[(axis + 1) % 3] = 1.0f;
            const glm::vec3 b = glm::cross(n, t);
            const uint32_t first = uint32_t(box.positions.size());
            for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
                box.positions.push_back(0.5f * (n + t * corner.x + b * corner.y));
                box.normals.push_back(n);
                box.tangents.emplace_back(t, 1.0f);
                box.uv0.push_back(0.5f * corner + 0.5f);
            }
            for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) box.indices.push_back(first + i);
        }
    box.boundsMin = glm::vec3(-0.5f);
    box.boundsMax = glm::vec3(0.5f);
    model->meshes.push_back({"box", {std::move(box)}, {}});
    scene::Node node;
    node.mesh = 0;
    model->nodes.push_back(node);
    model->roots = model->order = {0};
    return model;
}

std::filesystem::path pathFile(const Script& script) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(script.path, ignored)) return script.path;
    const auto found = app::findContent(script.path.string());
    if (!found) throw Complaint(fmt::format("{}: its camera path {} is not in content/", script.name, script.path.string()));
    return *found;
}

// A recorded path, in the scene that it names, from its first key or from "@SECONDS".
Script recorded(const std::string& text) {
    const size_t mark = text.rfind('@');
    Script script;
    script.path = text.substr(0, mark);
    const scene::CameraPath path = scene::loadCameraPath(script.path);
    if (path.scene.empty())
        throw Complaint(
            fmt::format("{}: names no scene; add \"scene\": a name of content/scenes.json or a glTF file", script.path.string()));
    script.scene = path.scene;
    script.title = path.name;
    script.name = scene::utf8(script.path.filename().string());
    script.name = script.name.substr(0, script.name.find('.'));
    script.start = path.keys.front().time;
    if (mark == std::string::npos) return script;
    const std::vector<float> at = app::numbers(text.substr(mark + 1), ',');
    if (at.size() != 1) throw Complaint(fmt::format("--flythrough {}: after @ comes a time in seconds", text));
    script.start = at[0];
    return script;
}

}  // namespace

std::vector<Script> scripts() {
    const scene::JsonFile json(app::expectContent("flythroughs.json"));
    const scene::JsonAt list = json.root().at("flythroughs").expectArray();
    std::vector<Script> all;
    for (size_t i = 0; i < list.size(); ++i) all.push_back(scriptOf(list.at(i)));
    return all;
}

Script findScript(const std::string& name) {
    if (name.find(".json") != std::string::npos) {
        Script script = recorded(name);
        app::expectScene(script.scene);
        return script;
    }
    std::vector<std::string> names;
    for (Script& script : scripts()) {
        names.push_back(script.name);
        if (script.name != name) continue;
        app::expectScene(script.scene);
        if (!script.camera) pathFile(script);
        return script;
    }
    throw Complaint(
        fmt::format("--flythrough {}: no such flythrough; {}, or the path of a recorded FILE.json", name, app::choices(name, names)));
}

Script sceneScript(const app::SceneFile& file, const std::string& view, const std::string& animation) {
    Script script;
    script.scene = file.named ? file.info.name : file.file.string();
    script.view = view;
    script.animation = animation;
    std::string name = view;
    if (view != "orbit") {
        const measure::CameraChoice choice = measure::cameraOf(view);
        using Kind = measure::CameraChoice::Kind;
        if (choice.kind == Kind::path) {
            script.path = choice.file.empty() && file.flythrough ? *file.flythrough : choice.file;
            script.start = choice.at;
        }
        const std::filesystem::path needed = choice.kind == Kind::path ? script.path : choice.file;
        std::error_code ignored;
        if ((choice.kind == Kind::path || choice.kind == Kind::file) && !std::filesystem::is_regular_file(needed, ignored))
            throw Complaint(fmt::format("--camera {}: no such file", view));
        name = view.substr(view.find_last_of('/') + 1);
    }
    script.name = fmt::format("{}.{}", file.info.name, scene::utf8(name));
    script.title = script.name;
    return script;
}

Stage::Stage(const Script& script) : m_script(script) {
    const app::SceneFile file = app::expectScene(script.scene);
    app::PlacedScene placed = app::loadScene(file, script.animation);
    const int lenses = scene::lensCount(*placed.instance.model);
    m_world.add(std::move(placed.instance));
    for (const std::string& remark : placed.remarks) fmt::print(stderr, "{}\n", app::oneLine(remark));
    if (!script.view.empty()) {
        const bool orbits = script.view == "orbit";
        const measure::CameraChoice choice = orbits ? measure::CameraChoice() : measure::cameraOf(script.view);
        using Kind = measure::CameraChoice::Kind;
        const bool ownLens = !orbits && choice.kind == Kind::own && !file.named && lenses > 0;
        if (choice.kind == Kind::lens && choice.lens >= lenses)
            throw Complaint(fmt::format("--camera {}: {} has {} cameras; --camera orbit needs none", script.view, file.info.name, lenses));
        if (choice.kind == Kind::lens || ownLens) m_lens = choice.lens;
        else if (orbits) m_path = scene::orbit(placed.bounds);
        else if (choice.kind == Kind::own) m_script.camera = file.named ? *file.camera() : scene::frame(placed.bounds);
        else if (choice.kind == Kind::file) m_script.camera = scene::loadCamera(choice.file);
        else m_path = scene::loadCameraPath(script.path);
        if (!file.named) m_near = scene::frame(placed.bounds).nearPlane;
    } else if (!script.camera) {
        m_path = scene::loadCameraPath(pathFile(script));
    }
    if (!script.events.empty()) m_box = unitBox();
}

const scene::World& Stage::worldAt(uint32_t frame) {
    std::map<std::string, const Event*> standing;
    for (const Event& event : m_script.events) {
        if (event.frame > frame) break;
        if (event.gone) standing.erase(event.box);
        else standing[event.box] = &event;
    }
    for (auto box = m_boxes.begin(); box != m_boxes.end();) {
        if (standing.count(box->first)) {
            ++box;
            continue;
        }
        m_world.remove(box->second);
        box = m_boxes.erase(box);
    }
    for (const auto& [name, event] : standing) {
        if (!m_boxes.count(name)) m_boxes[name] = m_world.add({.model = m_box, .animation = scene::kRestPose});
        for (scene::Instance& instance : m_world.instances())
            if (instance.id == m_boxes[name]) instance.placement = glm::scale(glm::translate(glm::mat4(1.0f), event->at), event->size);
    }
    return m_world;
}

scene::Camera Stage::cameraAt(uint32_t frame) const {
    if (m_script.camera) return *m_script.camera;
    if (m_lens) {
        const scene::Instance& first = m_world.instances().front();
        return scene::lensCamera(first, scene::evaluate(*first.model, first.animation, worldTimeAt(frame) + first.timeOffset), *m_lens);
    }
    scene::Camera camera = m_path.at(m_script.timeAt(frame));
    if (m_near) camera.nearPlane = *m_near;
    return camera;
}

}  // namespace obscura::flythrough
