#include "toasters/toaster_scene.h"

#include "meshkit/shapes.h"
#include "toasters/toaster_motion.h"
#include "toasters/tray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace obscura::toasters {

using namespace kit;

namespace {

constexpr float kSampleRate = 30.0f;
constexpr glm::vec3 kAxisX{1.0f, 0.0f, 0.0f};
constexpr glm::vec3 kAxisY{0.0f, 1.0f, 0.0f};

/// Boards with grain along x and thin dark joints; repeats in both directions.
Image paintWood() {
    constexpr int kBoards = 6;
    return paint(512, 512, [](glm::vec2 uv) {
        const float board = std::floor(uv.y * kBoards);
        const float across = uv.y * kBoards - board;
        const auto seed = static_cast<std::uint32_t>(board);
        const float wobble = fractalNoise({uv.x * 4.0f, uv.y * 24.0f}, {4, 24}, 7 + seed, 3);
        const float rings = 0.5f + 0.5f * std::sin(18.0f * (across + 0.9f * wobble) + 5.0f * hash01(seed));
        const float fibre = fractalNoise({uv.x * 12.0f, uv.y * 160.0f}, {12, 160}, 31, 2);
        const float tone = 0.78f + 0.12f * rings + 0.16f * (fibre - 0.5f) + 0.1f * (hash01(seed, 3) - 0.5f);
        const float joint = smoothStep(0.0f, 0.025f, std::min(across, 1.0f - across));
        return glm::vec4(glm::vec3(0.82f, 0.62f, 0.42f) * tone * glm::mix(0.45f, 1.0f, joint), 1.0f);
    });
}

struct Shapes {
    int jaw = kNone;
    int head = kNone;
    int eye = kNone;
    int key = kNone;
    int legs = kNone;
    int toast = kNone;
};

class Builder {
public:
    Scene build();

private:
    void addMaterials();
    void addToy(int index, const Script& script);
    void addEyes(int index, int head, const std::vector<int>& materials);
    void animateKey(int node, int turns);

    Scene m_scene;
    Shapes m_shapes;
    std::vector<int> m_materials;
    std::vector<int> m_paints;
};

void Builder::addMaterials() {
    const int wood = m_scene.addImage("wood", paintWood());
    m_materials.assign(kSlotCount, kNone);
    const auto add = [&](Slot slot, Material material) { m_materials[slot] = m_scene.addMaterial(std::move(material)); };
    add(kChrome, {"chrome", srgb(0xD9DCE0), 1.0f, 0.14f});
    add(kBrass, {"brass", srgb(0xE2B65A), 1.0f, 0.26f});
    add(kMouth, {"mouth", srgb(0x7A1F2B), 0.0f, 0.55f});
    add(kEnamel, {"enamel", srgb(0xF6F2E8), 0.0f, 0.15f});
    add(kPupil, {"pupil", srgb(0x101014), 0.0f, 0.08f});
    add(kRubber, {"rubber", srgb(0x2B2B30), 0.0f, 0.75f});
    add(kBread, {"bread", srgb(0xEBC88A), 0.0f, 0.9f});
    add(kCrust, {"crust", srgb(0x9A5A26), 0.0f, 0.85f});
    add(kWood, {"tray wood", glm::vec4(1.0f), 0.0f, 0.5f, wood});
    add(kDarkWood, {"tray rim", glm::vec4(0.42f, 0.3f, 0.26f, 1.0f), 0.0f, 0.4f, wood});
    constexpr std::array<std::uint32_t, 5> kColours{0xC8322B, 0x2E8C86, 0xE3A21A, 0x3F6FB5, 0xE9DDC3};
    for (std::uint32_t colour : kColours)
        m_paints.push_back(m_scene.addMaterial({"paint " + std::to_string(m_paints.size()), srgb(colour), 0.0f, 0.28f}));
}

void Builder::animateKey(int node, int turns) {
    // A steady turn about z. Its cubic tangents are the derivative of (0, 0, sin a/2, cos a/2).
    constexpr int kKeysPerTurn = 4;
    Channel channel{node, Path::Rotation, Interpolation::CubicSpline, {}, {}};
    const int count = turns * kKeysPerTurn;
    const float halfSpeed = glm::pi<float>() * static_cast<float>(turns) / kDuration;
    for (int i = 0; i <= count; ++i) {
        const float part = static_cast<float>(i) / static_cast<float>(count);
        const float half = glm::pi<float>() * static_cast<float>(i % (2 * kKeysPerTurn)) / kKeysPerTurn;
        const glm::vec2 value{std::sin(half), std::cos(half)};
        const glm::vec2 tangent{halfSpeed * value.y, -halfSpeed * value.x};
        channel.times.push_back(part * kDuration);
        for (glm::vec2 v : {tangent, value, tangent}) channel.values.insert(channel.values.end(), {0.0f, 0.0f, v.x, v.y});
    }
    m_scene.channels.push_back(std::move(channel));
}

void Builder::addEyes(int index, int head, const std::vector<int>& materials) {
    const std::string number = std::to_string(index);
    const int mesh = m_scene.addMesh("eye " + number, m_shapes.eye, materials);
    // Eye rotations are stepped: they jump between keys.
    const auto seed = static_cast<std::uint32_t>(index);
    std::vector<float> times{0.0f};
    while (times.back() < kDuration - 1.2f)
        times.push_back(times.back() + 0.45f + 0.7f * hash01(seed, static_cast<std::uint32_t>(times.size())));
    times.push_back(kDuration);
    const auto look = [&](float time) {
        const auto key = time < kDuration ? static_cast<std::uint32_t>(time * 100.0f) : 0u;
        const float yaw = 0.75f * (hash01(seed, key, 1) - 0.5f);
        const float pitch = 0.5f * (hash01(seed, key, 2) - 0.5f);
        return glm::angleAxis(yaw, kAxisY) * glm::angleAxis(pitch, kAxisX);
    };
    for (float side : {1.0f, -1.0f}) {
        Node eye;
        eye.name = (side > 0.0f ? "eye_left_" : "eye_right_") + number;
        eye.parent = head;
        eye.translation = kEye * glm::vec3(side, 1.0f, 1.0f);
        eye.mesh = mesh;
        const int node = m_scene.addNode(eye);
        m_scene.animateRotation(node, times, look, Interpolation::Step);
    }
}

void Builder::addToy(int index, const Script& script) {
    const std::string number = std::to_string(index);
    std::vector<int> materials = m_materials;
    materials[kPaint] = m_paints[static_cast<std::size_t>(index) % m_paints.size()];
    const auto addPart = [&](const std::string& name, int parent, glm::vec3 place, int geometry) {
        Node node;
        node.name = name + "_" + number;
        node.parent = parent;
        node.translation = place;
        if (geometry != kNone) node.mesh = m_scene.addMesh(name + " " + number, geometry, materials);
        return m_scene.addNode(node);
    };

    // A skinned mesh must sit on a root node that stays put. The root shows the legs, and the node
    // below it does the walking, so that a toy's whole subtree can be shown on its own.
    Node root;
    root.name = "toaster_" + number;
    root.mesh = m_scene.addMesh("legs " + number, m_shapes.legs, materials);
    const int toy = m_scene.addNode(root);
    const int walker = addPart("walk", toy, {}, kNone);
    const int body = addPart("body", walker, {0.0f, kHipHeight, 0.0f}, m_shapes.jaw);
    const int head = addPart("head", body, kHinge, m_shapes.head);
    const int key = addPart("key", body, kKeyBearing, m_shapes.key);
    const int toast = addPart("toast", head, kToastSeat, m_shapes.toast);
    addEyes(index, head, materials);

    Skin skin{"legs " + number, walker, {}, {}};
    const glm::vec3 bone{0.0f, -kLegSegment, 0.0f};
    for (float side : {1.0f, -1.0f}) {
        const std::string suffix = side > 0.0f ? "_left" : "_right";
        glm::vec3 place{side * kHipSide, 0.0f, 0.0f};
        glm::vec3 bind{side * kHipSide, kHipHeight, 0.0f};
        int parent = body;
        for (const char* name : {"hip", "knee", "ankle"}) {
            parent = addPart(name + suffix, parent, place, kNone);
            skin.joints.push_back(parent);
            skin.inverseBind.push_back(translation(-bind));
            place = bone;
            bind += bone;
        }
    }
    const std::vector<int> joints = skin.joints;
    m_scene.nodes[toy].skin = m_scene.addSkin(std::move(skin));

    const ToyMotion motion(script, kTrayFloor);
    const std::vector<float> times = sampleTimes(kDuration, kSampleRate);
    std::vector<ToyPose> poses(times.size());
    std::transform(times.begin(), times.end(), poses.begin(), [&](float time) { return motion.at(time); });
    // The loop closes exactly, not only up to rounding.
    poses.back() = poses.front();
    const auto pose = [&](float time) -> const ToyPose& { return poses[static_cast<std::size_t>(std::lround(time * kSampleRate))]; };
    m_scene.animateTranslation(walker, times, [&](float t) { return pose(t).root.translation; });
    m_scene.animateRotation(walker, times, [&](float t) { return pose(t).root.rotation; });
    m_scene.animateTranslation(body, times, [&](float t) { return pose(t).body.translation; });
    m_scene.animateRotation(body, times, [&](float t) { return pose(t).body.rotation; });
    m_scene.animateRotation(head, times, [&](float t) { return pose(t).head; });
    for (std::size_t j = 0; j < joints.size(); ++j) m_scene.animateRotation(joints[j], times, [&](float t) { return pose(t).joints[j]; });
    m_scene.animateTranslation(toast, times, [&](float t) { return pose(t).toast.translation; });
    m_scene.animateRotation(toast, times, [&](float t) { return pose(t).toast.rotation; });
    m_scene.animateWeights(toast, times, [&](float t) { return std::vector<float>{pose(t).toastBend}; });
    constexpr int kKeyTurns = 8;
    animateKey(key, kKeyTurns);
}

Scene Builder::build() {
    m_scene.name = "toasters";
    m_scene.animation = "walk";
    addMaterials();
    m_shapes = {m_scene.addGeometry(makeJaw()), m_scene.addGeometry(makeHead()), m_scene.addGeometry(makeEye()),
        m_scene.addGeometry(makeKey()), m_scene.addGeometry(makeLegs()), m_scene.addGeometry(makeToast())};
    std::vector<int> trayMaterials = m_materials;
    trayMaterials[kPaint] = m_paints.front();
    Node tray;
    tray.name = "tray";
    tray.mesh = m_scene.addMesh("tray", m_scene.addGeometry(makeTray()), trayMaterials);
    m_scene.addNode(tray);
    const std::vector<Script> scripts = makeScripts();
    for (std::size_t i = 0; i < scripts.size(); ++i) addToy(static_cast<int>(i), scripts[i]);
    m_scene.addCamera({"main", 0.75f, 0.05f}, {1.3f, 1.75f, 3.7f}, {0.05f, 0.2f, 0.15f});
    return std::move(m_scene);
}

}  // namespace

Scene buildScene() { return Builder().build(); }

}  // namespace obscura::toasters
