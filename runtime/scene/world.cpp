// Instances of models, posed in world space.
#include "scene/world.h"

#include <algorithm>

namespace obscura::scene {
namespace {

glm::mat4 skinnedMatrix(const Model& model, const Node& node, const Pose& pose) {
    const Skin& skin = model.skins[size_t(node.skin)];
    return pose.world[size_t(skin.joints[0])] * skin.inverseBindMatrices[0];
}

Pose poseOf(const Instance& instance, float time) { return evaluate(*instance.model, instance.animation, time + instance.timeOffset); }

// Calls visit(instance, pose, node) for every drawn node that has a mesh, in drawing order.
template <class Visit>
void forEachDrawn(const World& world, float time, const Visit& visit) {
    for (const Instance& instance : world.instances()) {
        if (!instance.model) continue;
        const Pose posed = poseOf(instance, time);
        for (const int node : subtree(*instance.model, instance.root))
            if (instance.model->nodes[size_t(node)].mesh >= 0) visit(instance, posed, node);
    }
}

}  // namespace

size_t Model::triangleCount() const {
    size_t count = 0;
    for (const int node : order)
        if (const int mesh = nodes[size_t(node)].mesh; mesh >= 0)
            for (const Primitive& primitive : meshes[size_t(mesh)].primitives) count += primitive.indices.size() / 3;
    return count;
}

uint32_t World::add(Instance instance) {
    instance.id = m_nextId++;
    m_instances.push_back(std::move(instance));
    return m_instances.back().id;
}

void World::remove(uint32_t id) {
    m_instances.erase(
        std::remove_if(m_instances.begin(), m_instances.end(), [id](const Instance& i) { return i.id == id; }), m_instances.end());
}

void World::clear() { m_instances.clear(); }

size_t World::triangleCount() const {
    size_t count = 0;
    for (const Instance& instance : m_instances) {
        if (!instance.model) continue;
        for (const int node : subtree(*instance.model, instance.root))
            if (const int mesh = instance.model->nodes[size_t(node)].mesh; mesh >= 0)
                for (const Primitive& primitive : instance.model->meshes[size_t(mesh)].primitives) count += primitive.indices.size() / 3;
    }
    return count;
}

float World::duration() const {
    float longest = 0.0f;
    for (const Instance& instance : m_instances)
        if (instance.model)
            for (const int index : playing(*instance.model, instance.animation))
                longest = std::max(longest, instance.model->animations[size_t(index)].duration);
    return longest;
}

std::vector<PosedPrimitive> pose(const World& world, float time) {
    std::vector<PosedPrimitive> out;
    const Instance* last = nullptr;
    std::vector<bool> moving, morphing;
    forEachDrawn(world, time, [&](const Instance& instance, const Pose& posed, int index) {
        const Model& model = *instance.model;
        const Node& node = model.nodes[size_t(index)];
        if (last != &instance) {
            last = &instance;
            moving = animatedNodes(model, instance.animation);
            morphing = morphingNodes(model, instance.animation);
        }
        for (const Primitive& primitive : model.meshes[size_t(node.mesh)].primitives) {
            PosedPrimitive entry;
            entry.model = &model;
            entry.primitive = &primitive;
            entry.instance = instance.id;
            entry.node = index;
            const bool skinned = node.skin >= 0 && !primitive.joints.empty();
            const glm::mat4 matrix = instance.placement * (skinned ? skinnedMatrix(model, node, posed) : posed.world[size_t(index)]);
            entry.flipped = glm::determinant(glm::mat3(matrix)) < 0.0f;
            entry.moves = morphing[size_t(index)] && !primitive.targets.empty();
            if (skinned) {
                for (const int joint : model.skins[size_t(node.skin)].joints) entry.moves = entry.moves || moving[size_t(joint)];
            } else {
                entry.moves = entry.moves || moving[size_t(index)];
            }
            deform(model, index, primitive, posed, entry.positions, nullptr);
            for (glm::vec3& p : entry.positions) p = glm::vec3(instance.placement * glm::vec4(p, 1.0f));
            out.push_back(std::move(entry));
        }
    });
    return out;
}

void Bounds::add(const glm::vec3& p) {
    min = empty ? p : glm::min(min, p);
    max = empty ? p : glm::max(max, p);
    empty = false;
}

Bounds bounds(const World& world, float time) {
    Bounds box;
    std::vector<glm::vec3> positions;
    forEachDrawn(world, time, [&](const Instance& instance, const Pose& posed, int index) {
        const Model& model = *instance.model;
        const Node& node = model.nodes[size_t(index)];
        for (const Primitive& primitive : model.meshes[size_t(node.mesh)].primitives) {
            deform(model, index, primitive, posed, positions, nullptr);
            for (const glm::vec3& p : positions) box.add(glm::vec3(instance.placement * glm::vec4(p, 1.0f)));
        }
    });
    return box;
}

std::vector<int> subtree(const Model& model, int root) {
    if (root < 0 || size_t(root) >= model.nodes.size()) return model.order;
    std::vector<int> out, stack{root};
    while (!stack.empty()) {
        const int node = stack.back();
        stack.pop_back();
        out.push_back(node);
        const auto& children = model.nodes[size_t(node)].children;
        stack.insert(stack.end(), children.rbegin(), children.rend());
    }
    return out;
}

std::vector<bool> animatedNodes(const Model& model, int animation) {
    std::vector<bool> moving(model.nodes.size(), false);
    for (const int index : playing(model, animation))
        for (const Channel& channel : model.animations[size_t(index)].channels)
            if (channel.path != AnimatedPath::weights) moving[size_t(channel.node)] = true;
    for (const int node : model.order)
        if (const int parent = model.nodes[size_t(node)].parent; parent >= 0 && moving[size_t(parent)]) moving[size_t(node)] = true;
    return moving;
}

std::vector<bool> morphingNodes(const Model& model, int animation) {
    std::vector<bool> morphing(model.nodes.size(), false);
    for (const int index : playing(model, animation))
        for (const Channel& channel : model.animations[size_t(index)].channels)
            if (channel.path == AnimatedPath::weights) morphing[size_t(channel.node)] = true;
    return morphing;
}

}  // namespace obscura::scene
