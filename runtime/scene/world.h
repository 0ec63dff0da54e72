// The world: instances of models. The game owns and changes one World; renderer, voxels and references evaluate it at a time.
#pragma once

#include <memory>
#include <vector>

#include "scene/pose.h"

namespace obscura::scene {

struct Instance {
    std::shared_ptr<const Model> model;
    glm::mat4 placement{1.0f};       // model -> world, metres
    int animation = kAllAnimations;  // or an index, or kRestPose
    float timeOffset = 0.0f;         // seconds added to the world's time
    int root = -1;                   // draw only this node's subtree; -1 draws all
    uint32_t id = 0;                 // set by World::add(): constant, unique in the world, not 0
};

class World {
public:
    // Returns the id. Instances keep their order.
    uint32_t add(Instance instance);
    void remove(uint32_t id);
    void clear();
    const std::vector<Instance>& instances() const { return m_instances; }
    std::vector<Instance>& instances() { return m_instances; }
    size_t triangleCount() const;
    // Longest animation of any instance, seconds; 0 without animations.
    float duration() const;

private:
    std::vector<Instance> m_instances;
    uint32_t m_nextId = 1;
};

// The world's posed triangles at a time, in world space. One entry per drawn primitive, in drawing order.
struct PosedPrimitive {
    const Model* model = nullptr;
    const Primitive* primitive = nullptr;  // indices, uv, colours
    uint32_t instance = 0;                 // Instance::id
    int node = -1;
    bool flipped = false;  // negative determinant: winding is reversed
    bool moves = false;    // node-, skin- or morph-animated
    std::vector<glm::vec3> positions;
};
std::vector<PosedPrimitive> pose(const World& world, float time);

struct Bounds {
    glm::vec3 min{0.0f};
    glm::vec3 max{0.0f};
    bool empty = true;
    void add(const glm::vec3& p);
    glm::vec3 centre() const { return 0.5f * (min + max); }
    float radius() const { return 0.5f * glm::length(max - min); }
};
Bounds bounds(const World& world, float time);

// Nodes in the subtree of `root` (or all of model.order for -1), parents first.
std::vector<int> subtree(const Model& model, int root);
// Which nodes' matrices can change under an animation, as of Instance (own channel or an ancestor's).
std::vector<bool> animatedNodes(const Model& model, int animation);
// Which nodes have animated morph weights.
std::vector<bool> morphingNodes(const Model& model, int animation);

}  // namespace obscura::scene
