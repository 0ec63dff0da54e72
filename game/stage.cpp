#include "stage.h"

#include <algorithm>
#include <cctype>
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

// "toaster_3", whatever the case and with or without the underscore: the root of one toy.
bool isToyRoot(const std::string& name) {
    std::string lower;
    for (const char c : name) lower += char(std::tolower((unsigned char)c));
    if (!lower.starts_with("toaster")) return false;
    const size_t digits = lower.size() > 7 && lower[7] == '_' ? 8 : 7;
    return digits < lower.size() && std::all_of(lower.begin() + long(digits), lower.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// The first node of a toy whose translation is animated: it moves the toy.
int walkerOf(const scene::Model& model, int root) {
    for (const int node : scene::subtree(model, root))
        for (const scene::Animation& animation : model.animations)
            for (const scene::Channel& channel : animation.channels)
                if (channel.node == node && channel.path == scene::AnimatedPath::translation) return node;
    return root;
}

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
    loadToys(!info.toys.empty());
    for (const app::ToyGroup& group : info.toys) placeGroup(group);
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

void Stage::loadToys(bool wanted) {
    // The scene may be toasters.glb itself; then its model is shared.
    const std::optional<fs::path> found = app::findContent(kToysFile);
    const scene::Instance& first = world.instances().front();
    if (found && found->string() == file) m_toys = first.model;
    else if (found) m_toys = scene::loadGltf(*found);
    if (!m_toys) {
        if (wanted)
            remarks.push_back(
                fmt::format("{} is missing, so the scene has no toasters; build the target content, which makes it", kToysFile));
        return;
    }
    for (const int node : m_toys->order)
        if (isToyRoot(m_toys->nodes[size_t(node)].name)) m_toyKinds.push_back({node, walkerOf(*m_toys, node), 1e9f});
    // Toys hop: the ground is at the lowest position of the feet.
    const float duration = m_toys->animations.empty() ? 0.0f : m_toys->animations.front().duration;
    constexpr int kSamples = 32;
    for (int i = 0; i < kSamples; ++i) {
        const scene::Pose pose = scene::evaluate(*m_toys, 0, duration * float(i) / kSamples);
        for (Toy& toy : m_toyKinds) toy.ground = std::min(toy.ground, pose.world[size_t(toy.feet)][3].y);
    }
    if (m_toyKinds.empty()) m_toys = nullptr;
}

void Stage::placeGroup(const app::ToyGroup& group) {
    for (const Toy& toy : m_toyKinds) {
        glm::mat4 placement = glm::translate(glm::mat4(1.0f), group.at);
        placement = glm::rotate(placement, group.turn, glm::vec3(0, 1, 0));
        placement = glm::scale(placement, glm::vec3(group.scale));
        placement = glm::translate(placement, glm::vec3(0.0f, -toy.ground, 0.0f));
        world.add({.model = m_toys, .placement = placement, .timeOffset = group.time, .root = toy.root});
    }
}

// The place itself, or the first one along a sunflower's spiral around it where nothing was dropped.
glm::vec3 Stage::freePlace(const glm::vec3& at) const {
    glm::vec3 place = at;
    for (size_t i = 0; i < 4 * kMostToys; ++i) {
        const float angle = 2.3999632f * float(i), radius = 0.4f * info.toyScale * std::sqrt(float(i));
        place = at + radius * glm::vec3(std::cos(angle), 0.0f, std::sin(angle));
        place.x = std::clamp(place.x, info.walkMin.x, info.walkMax.x);
        place.z = std::clamp(place.z, info.walkMin.y, info.walkMax.y);
        place.y = info.floor;
        if (std::none_of(
                m_dropped.begin(), m_dropped.end(), [&](const Dropped& d) { return glm::distance(d.at, place) < 0.5f * info.toyScale; }))
            break;
    }
    return place;
}

bool Stage::dropToy(const glm::vec3& wanted, float turn, float time) {
    if (!m_toys || m_dropped.size() >= kMostToys) return false;
    // Successive toys differ in model and animation phase, so that they do not move in step.
    const glm::vec3 at = freePlace(wanted);
    const Toy& toy = m_toyKinds[m_dropped.size() % m_toyKinds.size()];
    const float offset = 1.37f * float(m_dropped.size());
    const scene::Pose pose = scene::evaluate(*m_toys, 0, time + offset);
    const glm::vec3 stands(pose.world[size_t(toy.feet)][3]);
    glm::mat4 placement = glm::translate(glm::mat4(1.0f), at);
    placement = glm::rotate(placement, turn, glm::vec3(0, 1, 0));
    placement = glm::scale(placement, glm::vec3(info.toyScale));
    placement = glm::translate(placement, glm::vec3(-stands.x, -toy.ground, -stands.z));
    m_dropped.push_back({world.add({.model = m_toys, .placement = placement, .timeOffset = offset, .root = toy.root}), at});
    return true;
}

void Stage::dropToys(uint32_t count, float time) {
    const glm::vec3 middle = floorAhead(startCamera());
    for (uint32_t i = 0; i < count; ++i)
        if (!dropToy(middle, 2.3999632f * float(i), time)) return;
}

void Stage::removeToy() {
    if (m_dropped.empty()) return;
    world.remove(m_dropped.back().id);
    m_dropped.pop_back();
}

void Stage::clearToys() {
    while (!m_dropped.empty()) removeToy();
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
