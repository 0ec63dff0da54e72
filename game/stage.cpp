#include "stage.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "app/complaint.h"
#include "scene/json_text.h"

namespace obscura::game {

namespace fs = std::filesystem;
using app::Complaint;

namespace {

constexpr const char* kToysFile = "toasters.glb";

}  // namespace

Stage::Stage(const std::string& scene, bool bare, const std::string& animation) {
    const auto begun = std::chrono::steady_clock::now();
    const app::SceneFile found = app::findScene(scene);
    info = found.info;
    if (found.file.empty()) throw Complaint(fmt::format("--scene {}: {} is missing; {}", info.name, info.files.front(), info.howToGet));
    file = found.file.string();
    app::PlacedScene placed = app::loadScene(found, animation);
    bounds = placed.bounds;
    world.add(std::move(placed.instance));
    remarks = std::move(placed.remarks);
    if (bare) info.toys.clear();
    if (!found.named) describe();
    toys = std::make_unique<Toys>(world, info, toyModel());
    bounds = scene::bounds(world, 0.0f);
    path = found.flythrough ? scene::loadCameraPath(*found.flythrough) : scene::orbit(bounds);
    loadSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

// The entry that the manifest lacks.
void Stage::describe() {
    info.title = scene::utf8(fs::path(file).filename().string());
    const scene::Camera camera = scene::frame(bounds);
    info.floor = bounds.min.y;
    info.eye = camera.eye;
    info.target = camera.target;
    info.toyScale = std::clamp(bounds.radius() * 0.25f, 0.2f, 3.0f);
    info.walkMin = {bounds.min.x - bounds.radius(), bounds.min.z - bounds.radius()};
    info.walkMax = {bounds.max.x + bounds.radius(), bounds.max.z + bounds.radius()};
}

// Null, with a remark if the scene wants it, if there is none.
std::shared_ptr<const scene::Model> Stage::toyModel() {
    // The scene may be toasters.glb itself; then its model is shared.
    const std::optional<fs::path> found = app::findContent(kToysFile);
    const scene::Instance& first = world.instances().front();
    if (found && found->string() == file) return first.model;
    if (found) return scene::loadGltf(*found);
    if (!info.toys.empty())
        remarks.push_back(fmt::format("{} is missing, so the scene has no toasters; build the target content, which makes it", kToysFile));
    return nullptr;
}

void Stage::dropToys(uint32_t count, float time) {
    const glm::vec3 middle = floorAhead(startCamera());
    for (uint32_t i = 0; i < count; ++i)
        if (!toys->drop(middle, 2.3999632f * float(i), time)) return;
}

glm::vec3 Stage::floorAhead(const scene::Camera& camera) const {
    const glm::vec3 forward = glm::normalize(camera.target - camera.eye);
    const float ahead = std::clamp(bounds.radius() * 0.5f, 1.0f, 6.0f), farthest = 1.5f * ahead;
    const float down = camera.eye.y - info.floor;
    float distance = forward.y < -1e-3f && down > 0.0f ? down / -forward.y : ahead;
    distance = std::min(distance, farthest);
    glm::vec3 at = camera.eye + distance * forward;
    at.x = std::clamp(at.x, info.walkMin.x, info.walkMax.x);
    at.z = std::clamp(at.z, info.walkMin.y, info.walkMax.y);
    at.y = info.floor;
    return at;
}

float Stage::moveSpeed() const { return std::clamp(bounds.radius() * 0.4f, 0.3f, 3.0f); }

scene::Camera Stage::startCamera() const {
    scene::Camera camera = scene::frame(bounds);
    camera.eye = info.eye;
    camera.target = info.target;
    return camera;
}

bool Stage::moves(const CameraChoice& choice) const {
    using Kind = CameraChoice::Kind;
    return choice.kind == Kind::flythrough || choice.kind == Kind::lens || (choice.kind == Kind::path && !choice.at);
}

const scene::CameraPath& Stage::pathOf(const fs::path& path_) {
    if (path_ != m_chosenFile) m_chosenPath = scene::loadCameraPath(path_);
    m_chosenFile = path_;
    return m_chosenPath;
}

scene::Camera Stage::camera(const CameraChoice& choice, float time) {
    using Kind = CameraChoice::Kind;
    scene::Camera camera = startCamera();
    const float near = camera.nearPlane;
    if (choice.kind == Kind::flythrough) {
        camera = path.at(time);
        camera.nearPlane = near;
    } else if (choice.kind == Kind::path) {
        camera = pathOf(choice.file).at(choice.at.value_or(time));
        camera.nearPlane = near;
    } else if (choice.kind == Kind::file) {
        camera = scene::loadCamera(choice.file);
    } else if (choice.kind == Kind::fixed) {
        camera.eye = choice.eye;
        camera.target = choice.target;
    } else if (choice.kind == Kind::lens) {
        const scene::Instance& instance = world.instances().front();
        const int count = scene::lensCount(*instance.model);
        if (choice.lens >= count)
            throw Complaint(fmt::format("--camera scene:{}: {} has {}", choice.lens, file,
                count == 0 ? "no cameras; use --eye and --target" : fmt::format("cameras 0 to {}", count - 1)));
        camera = scene::lensCamera(instance, scene::evaluate(*instance.model, instance.animation, time + instance.timeOffset), choice.lens);
    }
    if (choice.fovDegrees) camera.fovY = glm::radians(*choice.fovDegrees);
    return camera;
}

std::string sceneList() {
    std::string text;
    for (const app::SceneFile& scene : app::namedScenes())
        text += fmt::format("{:<10} {}\n{:<10} {}\n", scene.info.name, scene.info.title, "",
            scene.file.empty() ? "missing: " + scene.info.howToGet : scene.file.string());
    return text;
}

}  // namespace obscura::game
