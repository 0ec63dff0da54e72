#include "atrium/atrium_scene.h"

#include "atrium/atrium_parts.h"
#include "atrium/atrium_textures.h"
#include "meshkit/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace obscura::atrium {

using namespace kit;

namespace {

constexpr float kTau = glm::two_pi<float>();
constexpr glm::vec3 kUp{0.0f, 1.0f, 0.0f};

/// A bay of the arcade: its middle on the line of columns, and the turn that makes +z face the court.
struct Bay {
    glm::vec3 place{0.0f};
    float degrees = 0.0f;
};

/// The bays along a rectangle whose sides lie at the given distances from the middle.
std::vector<Bay> baysAlong(float halfX, float halfZ) {
    std::vector<Bay> bays;
    for (int i = 0; i < kBaysLong; ++i) {
        const float x = -kCourtX + kBay * (static_cast<float>(i) + 0.5f);
        bays.push_back({{x, 0, -halfZ}, 0.0f});
        bays.push_back({{x, 0, halfZ}, 180.0f});
    }
    for (int i = 0; i < kBaysShort; ++i) {
        const float z = -kCourtZ + kBay * (static_cast<float>(i) + 0.5f);
        bays.push_back({{-halfX, 0, z}, 90.0f});
        bays.push_back({{halfX, 0, z}, -90.0f});
    }
    return bays;
}

class Builder {
public:
    Scene build();

private:
    void addMaterials();
    int addMesh(const std::string& name, Geometry geometry);
    int place(int mesh, glm::vec3 at, float degrees = 0.0f, int parent = kNone);
    void addShell();
    void addArcades();
    void addFurnishings();
    void addLantern();
    void addCloth();
    void addBanners(int geometry, int rod, glm::vec3 at, float degrees, int index);
    /// Sways a cloth: its two targets are weighted round a circle, faster and slower with the gusts.
    void sway(int node, int turns, float phase, Interpolation interpolation);

    Scene m_scene;
    std::vector<int> m_materials;
    std::vector<int> m_clothColours;
};

void Builder::addMaterials() {
    const int stone = m_scene.addImage("stone", paintStone());
    const int plaster = m_scene.addImage("plaster", paintPlaster());
    const int marble = m_scene.addImage("marble", paintMarble());
    const int cloth = m_scene.addImage("cloth", paintCloth());
    const int leaf = m_scene.addImage("leaf", paintLeaf());
    m_materials.assign(kSlotCount, kNone);
    const auto add = [&](Slot slot, Material material) { m_materials[slot] = m_scene.addMaterial(std::move(material)); };
    add(kStone, {"stone", glm::vec4(1.0f), 0.0f, 0.75f, stone});
    add(kPlaster, {"plaster", glm::vec4(1.0f), 0.0f, 0.9f, plaster});
    add(kTiles, {"tiles", srgb(0xF2E6D2), 0.0f, 0.35f, marble});
    add(kDarkStone, {"dark tiles", srgb(0x9C5A44), 0.0f, 0.4f, marble});
    add(kWood, {"wood", srgb(0x6E4A2E), 0.0f, 0.7f});
    add(kIron, {"iron", srgb(0x4A4A4E), 0.9f, 0.45f});
    add(kTerracotta, {"terracotta", srgb(0xB5653F), 0.0f, 0.8f});
    add(kSoil, {"soil", srgb(0x3A2A1E), 0.0f, 1.0f});
    add(kLeaf, {"leaf", glm::vec4(1.0f), 0.0f, 0.6f, leaf, true, true});
    add(kGlow, {"candle", srgb(0xFFF1D0), 0.0f, 0.6f, kNone, false, false, glm::vec3(1.0f, 0.72f, 0.36f)});
    for (std::uint32_t colour : {0xD0382Eu, 0x2F5FA8u, 0x2E8A57u, 0xD9902Au})
        m_clothColours.push_back(
            m_scene.addMaterial({"cloth " + std::to_string(m_clothColours.size()), srgb(colour), 0.0f, 0.85f, cloth, false, true}));
    m_materials[kCloth] = m_clothColours.front();
}

int Builder::addMesh(const std::string& name, Geometry geometry) {
    return m_scene.addMesh(name, m_scene.addGeometry(std::move(geometry)), m_materials);
}

int Builder::place(int mesh, glm::vec3 at, float degrees, int parent) {
    Node node;
    node.name = m_scene.meshes[mesh].name + " " + std::to_string(m_scene.nodes.size());
    node.parent = parent;
    node.translation = at;
    if (degrees != 0.0f) node.rotation = glm::angleAxis(glm::radians(degrees), kUp);
    node.mesh = mesh;
    return m_scene.addNode(node);
}

void Builder::addShell() {
    place(addMesh("court floor", makeCourtFloor()), {});
    place(addMesh("walk floor", makeWalkFloor()), {});
    place(addMesh("outer walls", makeOuterWalls()), {});
    const float lowerTop = kLowerColumn + kArchHeight;
    const float upperTop = kStoreyHeight + kUpperColumn + kArchHeight;
    place(addMesh("upper floor", makeSlab(lowerTop, kStoreyHeight)), {});
    place(addMesh("roof", makeSlab(upperTop, kRoofTop)), {});
    place(addMesh("lower cornice", makeCornice(kStoreyHeight, 0.22f)), {});
    place(addMesh("upper cornice", makeCornice(kRoofTop, 0.34f)), {});
}

void Builder::addArcades() {
    const int arch = addMesh("arch", makeArch(false));
    const int blindArch = addMesh("blind arch", makeArch(true));
    const int rail = addMesh("rail", makeRail());
    const int baluster = addMesh("baluster", makeBaluster());
    const int brackets = addMesh("brackets", makeBrackets());
    for (int storey = 0; storey < 2; ++storey) {
        const float floor = kStoreyHeight * static_cast<float>(storey);
        const float height = storey == 0 ? kLowerColumn : kUpperColumn;
        const int column = addMesh(storey == 0 ? "lower column" : "upper column", makeColumn(height));
        const int pier = addMesh(storey == 0 ? "lower pier" : "upper pier", makePier(height));
        for (int i = 0; i <= kBaysLong; ++i)
            for (float side : {-1.0f, 1.0f}) {
                const bool isCorner = i == 0 || i == kBaysLong;
                place(isCorner ? pier : column, {-kCourtX + kBay * static_cast<float>(i), floor, side * kCourtZ});
            }
        for (int i = 1; i < kBaysShort; ++i)
            for (float side : {-1.0f, 1.0f}) place(column, {side * kCourtX, floor, -kCourtZ + kBay * static_cast<float>(i)});

        for (const Bay& bay : baysAlong(kCourtX, kCourtZ)) {
            place(arch, bay.place + kUp * (floor + height), bay.degrees);
            const glm::vec3 face = glm::angleAxis(glm::radians(bay.degrees), kUp) * glm::vec3(0, 0, 0.5f * kArchDepth);
            place(brackets, bay.place + face + kUp * (storey == 0 ? kStoreyHeight : kRoofTop), bay.degrees);
        }
        // The outer wall repeats the arcade in relief.
        for (const Bay& bay : baysAlong(kOuterX, kOuterZ)) place(blindArch, bay.place + kUp * (floor + height), bay.degrees);
    }
    for (const Bay& bay : baysAlong(kCourtX, kCourtZ)) {
        const glm::vec3 foot = bay.place + kUp * kStoreyHeight;
        const glm::vec3 along = glm::angleAxis(glm::radians(bay.degrees), kUp) * glm::vec3(1, 0, 0);
        place(rail, foot, bay.degrees);
        for (int i = 0; i < kBalusters; ++i)
            place(baluster, foot + along * (kBalusterSpacing * (static_cast<float>(i) - 0.5f * (kBalusters - 1))));
    }
}

void Builder::addFurnishings() {
    const int pot = addMesh("pot", makePot());
    const int plant = addMesh("plant", makePlant());
    const int bench = addMesh("bench", makeBench());
    constexpr float kPotX = kCourtX - 0.9f;
    constexpr float kPotZ = kCourtZ - 0.85f;
    const glm::vec2 spots[] = {{-kPotX, -kPotZ}, {kPotX, -kPotZ}, {-kPotX, kPotZ}, {kPotX, kPotZ}, {-5.0f, -kPotZ}, {5.0f, -kPotZ},
        {-5.0f, kPotZ}, {5.0f, kPotZ}, {-12.0f, -5.8f}, {12.0f, 5.8f}};
    for (glm::vec2 spot : spots) {
        const float turn = 360.0f * hash01(static_cast<std::uint32_t>(m_scene.nodes.size()));
        place(pot, {spot.x, 0, spot.y}, turn);
        place(plant, {spot.x, 0, spot.y}, turn);
    }
    for (float x : {-6.25f, -1.25f, 3.75f}) {
        place(bench, {x, 0, -kOuterZ + 0.55f});
        place(bench, {-x, 0, kOuterZ - 0.55f}, 180.0f);
    }
}

void Builder::addLantern() {
    // An iron bar across the court carries the chain.
    constexpr float kHangHeight = 9.35f;
    constexpr int kLinks = 12;
    constexpr float kLinkStep = 0.24f;
    Geometry bar{cylinder(0.035f, 2.0f * kCourtZ, 0.006f, 16), {}, {}};
    bar.mesh.setMaterial(kIron);
    smoothNormals(bar.mesh, 45.0f);
    Node beam;
    beam.name = "lantern bar";
    beam.translation = {0.0f, kHangHeight + 0.09f, -kCourtZ};
    beam.rotation = glm::angleAxis(0.5f * glm::pi<float>(), glm::vec3(1, 0, 0));
    beam.mesh = addMesh("lantern bar", std::move(bar));
    m_scene.addNode(beam);

    Node hook;
    hook.name = "lantern hook";
    hook.translation = {0.0f, kHangHeight, 0.0f};
    const int swing = m_scene.addNode(hook);
    const int links = addMesh("chain", makeChainLink());
    for (int i = 0; i < kLinks; ++i) place(links, kUp * (-kLinkStep * static_cast<float>(i)), 0.0f, swing);
    place(addMesh("lantern", makeLantern()), kUp * (-kLinkStep * kLinks + 0.01f), 0.0f, swing);
    // A pendulum of this length takes a little over 3 s; three swings fill the loop.
    m_scene.animateRotation(swing, sampleTimes(kDuration, 30.0f), [](float time) {
        const float angle = kTau * 3.0f * time / kDuration;
        return glm::angleAxis(0.045f * std::sin(angle), glm::vec3(0, 0, 1)) * glm::angleAxis(0.02f * std::cos(angle), glm::vec3(1, 0, 0));
    });
}

void Builder::sway(int node, int turns, float phase, Interpolation interpolation) {
    const float speed = kTau * static_cast<float>(turns) / kDuration;
    const auto weights = [&](float time) {
        const float gust = 0.75f + 0.25f * std::sin(kTau * time / kDuration + phase);
        const float angle = speed * time + phase;
        return std::vector<float>{gust * std::cos(angle), gust * std::sin(angle)};
    };
    if (interpolation == Interpolation::Linear) {
        m_scene.animateWeights(node, sampleTimes(kDuration, 30.0f), weights);
    } else {
        // Few keys suffice where the curve's own slopes are given as tangents.
        constexpr float kStep = 0.01f;
        Channel channel{node, Path::Weights, Interpolation::CubicSpline, sampleTimes(kDuration, 3.0f), {}};
        for (float time : channel.times) {
            const float at = time < kDuration ? time : 0.0f;
            const std::vector<float> before = weights(at - kStep);
            const std::vector<float> value = weights(at);
            const std::vector<float> after = weights(at + kStep);
            const std::vector<float> slope{(after[0] - before[0]) / (2.0f * kStep), (after[1] - before[1]) / (2.0f * kStep)};
            for (const std::vector<float>& part : {slope, value, slope})
                channel.values.insert(channel.values.end(), part.begin(), part.end());
        }
        m_scene.channels.push_back(std::move(channel));
    }
    // The loop closes exactly, not only up to rounding.
    std::vector<float>& values = m_scene.channels.back().values;
    const std::size_t keySize = interpolation == Interpolation::Linear ? 2 : 6;
    std::copy_n(values.begin(), keySize, values.end() - static_cast<std::ptrdiff_t>(keySize));
}

void Builder::addBanners(int geometry, int rod, glm::vec3 at, float degrees, int index) {
    std::vector<int> materials = m_materials;
    const auto colour = static_cast<std::size_t>(index) % m_clothColours.size();
    materials[kCloth] = m_clothColours[colour];
    const int mesh = m_scene.addMesh("banner " + std::to_string(index), geometry, materials);
    place(rod, at, degrees);
    const int node = place(mesh, at, degrees);
    const int turns = index % 3 == 0 ? 3 : 4;
    sway(node, turns, 1.7f * static_cast<float>(index), Interpolation::Linear);
}

void Builder::addCloth() {
    constexpr float kWidth = 1.25f;
    constexpr float kRodHeight = kStoreyHeight - 0.62f;
    const int geometry = m_scene.addGeometry(makeBanner(kWidth, 2.3f));
    const int rod = addMesh("banner rod", makeBannerRod(kWidth));
    constexpr float kOut = 0.5f * kArchDepth + 0.3f;
    int index = 0;
    for (float x : {-8.75f, -3.75f, 3.75f, 8.75f}) {
        addBanners(geometry, rod, {x, kStoreyHeight + kRodHeight, -kCourtZ + kOut}, 0.0f, index++);
        addBanners(geometry, rod, {x, kStoreyHeight + kRodHeight, kCourtZ - kOut}, 180.0f, index++);
    }
    const int awning = m_scene.addGeometry(makeAwning(2.6f, 2.0f * (kCourtZ - 0.3f), 1.3f));
    for (float side : {-1.0f, 1.0f}) {
        std::vector<int> materials = m_materials;
        materials[kCloth] = m_clothColours[side < 0.0f ? 3 : 1];
        const int mesh = m_scene.addMesh(side < 0.0f ? "awning west" : "awning east", awning, materials);
        const int node = place(mesh, {side * 6.25f, 9.3f, 0.0f});
        sway(node, 3, side, Interpolation::CubicSpline);
    }
}

Scene Builder::build() {
    m_scene.name = "atrium";
    m_scene.animation = "walk";
    addMaterials();
    addShell();
    addArcades();
    addFurnishings();
    addLantern();
    addCloth();
    m_scene.addCamera({"main", 1.05f, 0.05f}, {-9.0f, 1.75f, 1.3f}, {0.0f, 3.2f, -0.6f});
    return std::move(m_scene);
}

}  // namespace

Scene buildScene() { return Builder().build(); }

}  // namespace obscura::atrium
