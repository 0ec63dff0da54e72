#include "render/actors.h"

#include <algorithm>
#include <cmath>

namespace obscura::render {
namespace {

// Frames without motion until an object counts as settled. Large, since each object that settles or moves again makes the shadow map of all
// settled objects be redrawn.
constexpr uint32_t kSettled = 600;

scene::Bounds transformed(const scene::Bounds& box, const glm::mat4& matrix) {
    scene::Bounds out;
    if (box.empty) return out;
    const glm::vec3 centre = glm::vec3(matrix * glm::vec4(box.centre(), 1.0f));
    const glm::vec3 half = 0.5f * (box.max - box.min);
    const glm::vec3 reach =
        glm::abs(glm::vec3(matrix[0])) * half.x + glm::abs(glm::vec3(matrix[1])) * half.y + glm::abs(glm::vec3(matrix[2])) * half.z;
    out.add(centre - reach);
    out.add(centre + reach);
    return out;
}

void grow(scene::Bounds& box, const scene::Bounds& other) {
    if (other.empty) return;
    box.add(other.min);
    box.add(other.max);
}

scene::Bounds widened(scene::Bounds box, const glm::vec3& by) {
    box.min -= by;
    box.max += by;
    return box;
}

// Bound of the displacement of morphed vertices: the weighted sum of the targets' largest displacements.
glm::vec3 morphReach(const PrimitiveGpu& primitive, const std::vector<float>& weights) {
    glm::vec3 reach(0.0f);
    for (size_t t = 0; t < primitive.targetReach.size() && t < weights.size(); ++t)
        reach += std::abs(weights[t]) * primitive.targetReach[t];
    return reach;
}

bool samePose(const scene::Pose& a, const scene::Pose& b) { return a.world == b.world && a.weights == b.weights; }

}  // namespace

uint32_t Ranges::take(uint32_t count) {
    for (size_t i = 0; i < m_free.size(); ++i) {
        Free& free = m_free[i];
        if (free.count < count) continue;
        const uint32_t first = free.first;
        free.first += count;
        free.count -= count;
        if (free.count == 0) m_free.erase(m_free.begin() + ptrdiff_t(i));
        return first;
    }
    // Doubling, since growing copies the posed buffers.
    const uint32_t capacity = std::max({m_capacity * 2, m_capacity + count, 4096u});
    give(m_capacity, capacity - m_capacity);
    m_capacity = capacity;
    return take(count);
}

void Ranges::give(uint32_t first, uint32_t count) {
    auto at = std::lower_bound(m_free.begin(), m_free.end(), first, [](const Free& free, uint32_t value) { return free.first < value; });
    at = m_free.insert(at, {first, count});
    const auto joinNext = [&](auto it) {
        if (it + 1 == m_free.end() || it->first + it->count != (it + 1)->first) return;
        it->count += (it + 1)->count;
        m_free.erase(it + 1);
    };
    joinNext(at);
    if (at != m_free.begin()) joinNext(at - 1);
}

void Actors::release(Actor& actor) {
    for (PrimitiveState& state : actor.states)
        if (state.posed != kNotPosed) m_ranges.give(state.posed, state.vertices);
    actor.states.clear();
}

void Actors::rebuild(Actor& actor, const scene::Instance& instance, const ModelGpu& model) {
    release(actor);
    actor = {};
    actor.model = instance.model;
    actor.root = instance.root;
    const std::vector<bool> animated = scene::animatedNodes(*instance.model, instance.animation);
    for (const int node : scene::subtree(*instance.model, instance.root)) {
        const scene::Node& source = instance.model->nodes[size_t(node)];
        if (source.mesh < 0) continue;
        for (const PrimitiveGpu& primitive : model.meshes[size_t(source.mesh)]) {
            if (primitive.indexCount == 0) continue;
            PrimitiveState state{node, &primitive, primitive.skinned && source.skin >= 0};
            state.vertices = primitive.vertexCount;
            if (state.skinned || primitive.morphed) state.posed = m_ranges.take(state.vertices);
            if (state.posed == kNotPosed && !animated[size_t(node)]) state.rested = kSettled;
            actor.states.push_back(state);
        }
    }
}

void Actors::addJobs(const Actor& actor, const ModelGpu& model, const std::map<int, uint32_t>& skins) {
    for (const PrimitiveState& state : actor.states) {
        if (state.posed == kNotPosed) continue;
        const PrimitiveGpu& primitive = *state.primitive;
        shared::DeformJob job{};
        job.vertices = primitive.vertexCount;
        job.positions = primitive.restPositions;
        job.frames = primitive.restFrames;
        job.influences = state.skinned ? primitive.influences : ~0u;
        job.joints = state.skinned ? skins.at(actor.model->nodes[size_t(state.node)].skin) : 0;
        job.targets = primitive.targets;
        job.weights = uint32_t(m_weights.size());
        job.posed = state.posed;
        const std::vector<float>& weights = actor.pose.weights[size_t(state.node)];
        for (uint32_t t = 0; t < primitive.targetReach.size() && t < weights.size(); ++t)
            if (weights[t] != 0.0f) m_weights.push_back({t, weights[t]});
        job.weightCount = uint32_t(m_weights.size()) - job.weights;
        m_jobs.push_back({job, &model});
    }
}

void Actors::update(const scene::World& world, float time, bool cut, const FindModel& find) {
    m_drawables.clear();
    m_jobs.clear();
    m_joints.clear();
    m_weights.clear();
    for (auto& [id, actor] : m_actors) actor.seen = false;

    for (const scene::Instance& instance : world.instances()) {
        const ModelGpu* model = instance.model ? find(instance.model.get()) : nullptr;
        if (!model) continue;
        Actor& actor = m_actors[instance.id];
        if (actor.model != instance.model || actor.root != instance.root) rebuild(actor, instance, *model);
        actor.seen = true;

        const bool fresh = actor.fresh || cut;
        const float when = time + instance.timeOffset;
        bool samePoses = !actor.fresh;
        if (actor.fresh || actor.time != when || actor.animation != instance.animation) {
            scene::Pose pose = scene::evaluate(*instance.model, instance.animation, when);
            samePoses = samePoses && samePose(pose, actor.pose);
            actor.pose = std::move(pose);
        }
        actor.unchanged = samePoses ? actor.unchanged + 1 : 0;
        if (!samePoses) actor.version = ++m_versions;
        actor.time = when;
        actor.animation = instance.animation;

        // Joint matrices of the skins in use; deformed bounds need them too.
        std::map<int, std::vector<glm::mat4>> skins;
        std::map<int, uint32_t> skinAt;
        // Positions are double-buffered: after two frames with the same pose both buffers have it.
        const bool deforms = actor.unchanged < 2;
        for (const PrimitiveState& state : actor.states) {
            const int skin = instance.model->nodes[size_t(state.node)].skin;
            if (!state.skinned || skins.count(skin)) continue;
            auto& matrices = skins[skin] = scene::jointMatrices(*instance.model, instance.model->skins[size_t(skin)], actor.pose);
            if (!deforms) continue;
            skinAt[skin] = uint32_t(m_joints.size() / 3);
            for (const glm::mat4& m : matrices)
                for (int row = 0; row < 3; ++row) m_joints.emplace_back(m[0][row], m[1][row], m[2][row], m[3][row]);
        }
        if (deforms) addJobs(actor, *model, skinAt);

        for (PrimitiveState& state : actor.states) {
            const PrimitiveGpu& primitive = *state.primitive;
            Drawable drawable;
            drawable.model = model;
            drawable.primitive = &primitive;
            drawable.posed = state.posed;
            drawable.fresh = fresh;
            drawable.version = state.posed == kNotPosed ? 0 : actor.version;
            drawable.world = state.skinned ? instance.placement : instance.placement * actor.pose.world[size_t(state.node)];
            drawable.previousWorld = fresh ? drawable.world : state.world;
            drawable.still = fresh || (drawable.world == state.world && (state.posed == kNotPosed || samePoses));
            state.rested = drawable.still ? std::min(state.rested + 1, kSettled) : 0;
            drawable.settled = state.rested >= kSettled;
            const glm::vec3 reach = morphReach(primitive, actor.pose.weights[size_t(state.node)]);
            glm::mat4 facing = drawable.world;
            if (state.skinned) {
                // A skinned vertex is a weighted mean of its transforms by its joints, so it is inside the hull of their boxes.
                const auto& matrices = skins[instance.model->nodes[size_t(state.node)].skin];
                for (const PrimitiveGpu::JointBox& box : primitive.jointBoxes)
                    grow(drawable.bounds, transformed(widened(box.box, reach), instance.placement * matrices[box.joint]));
                if (!primitive.jointBoxes.empty()) facing = instance.placement * matrices[primitive.jointBoxes.front().joint];
            } else {
                drawable.bounds = transformed(widened(primitive.bounds, reach), drawable.world);
            }
            drawable.flipped = glm::determinant(glm::mat3(facing)) < 0.0f;
            state.world = drawable.world;
            m_drawables.push_back(std::move(drawable));
        }
        actor.fresh = false;
    }
    for (auto it = m_actors.begin(); it != m_actors.end();) {
        if (it->second.seen) {
            ++it;
            continue;
        }
        release(it->second);
        it = m_actors.erase(it);
    }
}

}  // namespace obscura::render
