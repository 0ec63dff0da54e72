#include "toys.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <utility>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace obscura::game {

namespace {

constexpr float kGolden = 2.3999632f;  // radians, the golden angle

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

float wrapped(float angle) { return angle - glm::two_pi<float>() * std::round(angle / glm::two_pi<float>()); }

glm::mat4 standing(const glm::vec3& at, float turn) { return glm::rotate(glm::translate(glm::mat4(1.0f), at), turn, glm::vec3(0, 1, 0)); }

float turnOf(const glm::mat4& m) { return std::atan2(m[2].x, m[2].z); }

// All triangles of what never moves, three corners each.
std::vector<glm::vec3> restingCorners(const scene::World& world, float time) {
    std::vector<glm::vec3> corners;
    for (const scene::PosedPrimitive& part : scene::pose(world, time))
        if (!part.moves)
            for (const uint32_t index : part.primitive->indices) corners.push_back(part.positions[index]);
    return corners;
}

}  // namespace

Toys::Toys(scene::World& world, const app::SceneInfo& info, std::shared_ptr<const scene::Model> model)
    : m_world(world), m_info(info), m_model(std::move(model)) {
    if (!m_model) return;
    for (const int node : m_model->order)
        if (isToyRoot(m_model->nodes[size_t(node)].name)) m_kinds.push_back({node, walkerOf(*m_model, node), 1e9f, {}, {}});
    // Toys hop: the ground is at the lowest position of the feet.
    m_duration = m_model->animations.empty() ? 0.0f : m_model->animations.front().duration;
    constexpr int kSamples = 32;
    for (int i = 0; i < kSamples; ++i) {
        const scene::Pose pose = scene::evaluate(*m_model, 0, m_duration * float(i) / kSamples);
        for (Kind& kind : m_kinds) kind.ground = std::min(kind.ground, pose.world[size_t(kind.feet)][3].y);
    }
    // The scene may be the toys' own file, or its manifest entry sets groups of them down.
    const scene::Instance& scene = m_world.instances().front();
    if (scene.model == m_model)
        for (size_t k = 0; k < m_kinds.size(); ++k) m_groups.push_back({scene.id, k, 1.0f, scene.timeOffset, {}});
    for (const app::ToyGroup& group : info.toys)
        for (size_t k = 0; k < m_kinds.size(); ++k) {
            glm::mat4 placement = glm::scale(standing(group.at, group.turn), glm::vec3(group.scale));
            placement = glm::translate(placement, glm::vec3(0.0f, -m_kinds[k].ground, 0.0f));
            const uint32_t id = m_world.add({.model = m_model, .placement = placement, .timeOffset = group.time, .root = m_kinds[k].root});
            m_groups.push_back({id, k, group.scale, group.time, {}});
        }
}

scene::Instance& Toys::instance(uint32_t id) {
    std::vector<scene::Instance>& all = m_world.instances();
    return *std::find_if(all.begin(), all.end(), [&](const scene::Instance& i) { return i.id == id; });
}

// Place and turn of the feet at ground height, in the model.
glm::mat4 Toys::steps(const Kind& kind, float time) const {
    const size_t count = kind.track.size();
    const float place = m_duration > 0.0f ? (time / m_duration - std::floor(time / m_duration)) * float(count) : 0.0f;
    const size_t first = std::min(size_t(place), count - 1);
    const glm::vec3 &a = kind.track[first], &b = kind.track[(first + 1) % count];
    const float part = place - float(first);
    const glm::vec2 at = glm::mix(glm::vec2(a), glm::vec2(b), part);
    return standing({at.x, kind.ground, at.y}, a.z + part * wrapped(b.z - a.z));
}

void Toys::startPhysics(float time) {
    if (m_physics) return;
    m_physics = std::make_unique<Physics>(m_info.floor);
    constexpr float kRate = 60.0f;  // samples a second
    const size_t count = std::max<size_t>(1, size_t(m_duration * kRate));
    for (size_t i = 0; i < count && !m_kinds.empty(); ++i) {
        const scene::Pose pose = scene::evaluate(*m_model, 0, m_duration * float(i) / float(count));
        for (Kind& kind : m_kinds) {
            const glm::mat4& feet = pose.world[size_t(kind.feet)];
            kind.track.push_back({feet[3].x, feet[3].z, turnOf(feet)});
        }
    }
    for (Kind& kind : m_kinds) {
        scene::World alone;
        alone.add({.model = m_model, .placement = glm::inverse(steps(kind, 0.0f)), .animation = 0, .root = kind.root});
        const scene::Bounds box = scene::bounds(alone, 0.0f);
        kind.halfSize = {std::max(-box.min.x, box.max.x), 0.5f * box.max.y, std::max(-box.min.z, box.max.z)};
    }
    for (Toy& toy : m_groups) {
        const glm::mat4 feet = instance(toy.instance).placement * steps(m_kinds[toy.kind], time + toy.offset);
        toy.body = m_physics->addFixed(toy.scale * m_kinds[toy.kind].halfSize, standing(glm::vec3(feet[3]), turnOf(feet)));
    }
    scene::World still;
    for (const scene::Instance& instance : m_world.instances())
        if (instance.root < 0) still.add(instance);
    m_walls = std::async(std::launch::async,
        [still = std::move(still), time, floor = m_info.floor] { return Physics::makeWalls(restingCorners(still, time), floor); });
}

void Toys::collectWalls(bool wait) {
    if (m_walls.valid() && (wait || m_walls.wait_for(std::chrono::seconds(0)) == std::future_status::ready)) m_physics->use(m_walls.get());
}

// The place itself, or the first one along a sunflower's spiral around it where nothing was dropped.
glm::vec3 Toys::freePlace(const glm::vec3& at) const {
    glm::vec3 place = at;
    for (size_t i = 0; i < 4 * kMost; ++i) {
        const float angle = kGolden * float(i), radius = 0.4f * m_info.toyScale * std::sqrt(float(i));
        place = at + radius * glm::vec3(std::cos(angle), 0.0f, std::sin(angle));
        place.x = std::clamp(place.x, m_info.walkMin.x, m_info.walkMax.x);
        place.z = std::clamp(place.z, m_info.walkMin.y, m_info.walkMax.y);
        place.y = m_info.floor;
        const auto taken = [&](const Toy& toy) { return glm::distance(toy.at, place) < 0.5f * m_info.toyScale; };
        if (std::none_of(m_dropped.begin(), m_dropped.end(), taken)) break;
    }
    return place;
}

bool Toys::drop(const glm::vec3& wanted, float turn, float time) {
    if (m_kinds.empty() || m_dropped.size() >= kMost) return false;
    startPhysics(time);
    // Successive toys differ in model and animation phase, so that they do not move in step.
    Toy toy{0, m_dropped.size() % m_kinds.size(), m_info.toyScale, 1.37f * float(m_dropped.size()), freePlace(wanted)};
    const Kind& kind = m_kinds[toy.kind];
    toy.body = m_physics->add(toy.scale * kind.halfSize, standing(toy.at, turn));
    toy.instance = m_world.add({.model = m_model, .timeOffset = toy.offset, .root = kind.root});
    place(toy, time);
    m_dropped.push_back(toy);
    if (!m_time) m_time = time;
    return true;
}

void Toys::removeLast() {
    if (m_dropped.empty()) return;
    const Toy& toy = m_dropped.back();
    if (toy.body == m_held) m_held = 0;
    m_physics->remove(toy.body);
    m_world.remove(toy.instance);
    m_dropped.pop_back();
}

// Its feet stand where those of its body do.
void Toys::place(const Toy& toy, float time) {
    const glm::mat4 feet = glm::scale(m_physics->feet(toy.body), glm::vec3(toy.scale));
    instance(toy.instance).placement = feet * glm::inverse(steps(m_kinds[toy.kind], time + toy.offset));
}

void Toys::advance(float time, const Pusher* player, bool wait) {
    constexpr float kLongest = 1.0f;  // seconds; more is a jump
    if (!m_physics) return;
    collectWalls(wait);
    const float before = m_time.value_or(time), passed = time - before;
    m_time = time;
    for (const Toy& toy : m_groups) {
        const glm::mat4 feet = instance(toy.instance).placement * steps(m_kinds[toy.kind], time + toy.offset);
        m_physics->place(toy.body, standing(glm::vec3(feet[3]), turnOf(feet)));
    }
    if (player) m_physics->player(player->camera.eye, player->standing);
    else m_physics->noPlayer();
    if (player && m_held) {
        const glm::vec3 ahead = glm::normalize(player->camera.target - player->camera.eye);
        const glm::vec3 at = player->camera.eye + (0.5f + 0.5f * m_info.toyScale) * ahead - glm::vec3(0.0f, 0.25f * m_info.toyScale, 0.0f);
        m_physics->place(m_held, standing(at, std::atan2(-ahead.x, -ahead.z)));
    }
    if (passed > 0.0f && passed <= kLongest) {
        for (const Toy& toy : m_dropped) {
            const Kind& kind = m_kinds[toy.kind];
            const glm::mat4 step = glm::inverse(steps(kind, before + toy.offset)) * steps(kind, time + toy.offset);
            m_physics->walk(toy.body, toy.scale / passed * glm::vec2(step[3].x, step[3].z), turnOf(step) / passed);
        }
        m_physics->step(passed);
    }
    for (const Toy& toy : m_dropped) place(toy, time);
}

Toys::Grabbed Toys::pickOrThrow(const scene::Camera& camera) {
    const glm::vec3 ahead = glm::normalize(camera.target - camera.eye);
    if (m_held) {
        const float speed = 5.0f * std::sqrt(m_info.toyScale);  // metres a second
        const glm::vec3 right = glm::normalize(glm::cross(ahead, glm::vec3(0, 1, 0)) + glm::vec3(1e-6f, 0, 0));
        m_physics->throwAway(std::exchange(m_held, 0u), speed * (ahead + glm::vec3(0.0f, 0.25f, 0.0f)), -4.0f * right);
        return Grabbed::thrown;
    }
    // The one nearest to the middle of the picture, unless something stands before it.
    constexpr float kWidest = 0.35f;  // radians
    const float reach = 2.0f + 2.0f * m_info.toyScale;
    uint32_t found = 0;
    float best = kWidest;
    for (const Toy& toy : m_dropped) {
        const glm::mat4 feet = m_physics->feet(toy.body);
        const glm::vec3 middle(feet * glm::vec4(0.0f, toy.scale * m_kinds[toy.kind].halfSize.y, 0.0f, 1.0f));
        const float angle = std::acos(std::clamp(glm::dot(ahead, glm::normalize(middle - camera.eye)), -1.0f, 1.0f));
        if (angle >= best || m_physics->firstAlong(camera.eye, middle - camera.eye, reach) != toy.body) continue;
        best = angle;
        found = toy.body;
    }
    if (!found) return Grabbed::nothing;
    m_held = found;
    m_physics->hold(found);
    return Grabbed::picked;
}

glm::vec3 Toys::slide(const glm::vec3& from, const glm::vec3& to) {
    startPhysics(m_time.value_or(0.0f));
    collectWalls(false);
    return m_physics->slide(from, to);
}

}  // namespace obscura::game
