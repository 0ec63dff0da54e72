#include "voxel/parts.h"

#include <algorithm>

namespace obscura::voxel {
namespace {

const scene::Mesh& meshOf(const scene::Model& model, const Part& part) { return model.meshes[size_t(model.nodes[size_t(part.node)].mesh)]; }

}  // namespace

bool Picked::operator()(const scene::Model& model, const scene::Primitive& primitive) const {
    const scene::AlphaMode mode = model.materials[size_t(primitive.material)].alphaMode;
    return !primitive.indices.empty() && mode != scene::AlphaMode::blend && (masked || mode != scene::AlphaMode::mask);
}

std::vector<Part> partsOf(const scene::Instance& instance, const Picked& picked) {
    const scene::Model& model = *instance.model;
    const std::vector<bool> moving = scene::animatedNodes(model, instance.animation);
    const std::vector<bool> morphing = scene::morphingNodes(model, instance.animation);
    std::vector<Part> parts;
    for (const int index : scene::subtree(model, instance.root)) {
        const scene::Node& node = model.nodes[size_t(index)];
        if (node.mesh < 0) continue;
        Part part{index};
        bool any = false;
        for (const scene::Primitive& primitive : meshOf(model, part).primitives) {
            if (!picked(model, primitive)) continue;
            any = true;
            const bool skinned = node.skin >= 0 && !primitive.joints.empty();
            bool shaped = morphing[size_t(index)] && !primitive.targets.empty();
            if (skinned)
                for (const int joint : model.skins[size_t(node.skin)].joints) shaped = shaped || moving[size_t(joint)];
            part.deforms = part.deforms || shaped;
            part.moves = part.moves || shaped || (!skinned && moving[size_t(index)]);
        }
        if (any) parts.push_back(part);
    }
    return parts;
}

size_t trianglesOf(const scene::Model& model, const Part& part, const Picked& picked) {
    size_t count = 0;
    for (const scene::Primitive& primitive : meshOf(model, part).primitives)
        if (picked(model, primitive)) count += primitive.indices.size() / 3;
    return count;
}

scene::Bounds boundsOf(const scene::Model& model, const Part& part, const Picked& picked) {
    scene::Bounds bounds;
    for (const scene::Primitive& primitive : meshOf(model, part).primitives) {
        if (!picked(model, primitive)) continue;
        scene::Bounds own;
        for (const glm::vec3& p : primitive.positions) own.add(p);
        glm::vec3 farthest(0.0f);  // sum of the largest displacements
        for (const scene::Primitive::Target& target : primitive.targets) {
            glm::vec3 most(0.0f);
            for (const glm::vec3& d : target.positions) most = glm::max(most, glm::abs(d));
            farthest += most;
        }
        if (own.empty) continue;
        bounds.add(own.min - farthest);
        bounds.add(own.max + farthest);
    }
    return bounds;
}

scene::Bounds boundsOf(const scene::Instance& instance, const Part& part, const scene::Pose& pose, const scene::Bounds& own) {
    const scene::Model& model = *instance.model;
    const scene::Node& node = model.nodes[size_t(part.node)];
    std::vector<glm::mat4> matrices{pose.world[size_t(part.node)]};
    if (node.skin >= 0) {  // a skinned vertex is a mean of its positions under the joints' matrices
        const std::vector<glm::mat4> joints = scene::jointMatrices(model, model.skins[size_t(node.skin)], pose);
        matrices.insert(matrices.end(), joints.begin(), joints.end());
    }
    scene::Bounds bounds;
    if (own.empty) return bounds;
    for (const glm::mat4& matrix : matrices)
        for (int i = 0; i < 8; ++i) {
            const glm::vec3 corner(i & 1 ? own.max.x : own.min.x, i & 2 ? own.max.y : own.min.y, i & 4 ? own.max.z : own.min.z);
            bounds.add(glm::vec3(instance.placement * matrix * glm::vec4(corner, 1.0f)));
        }
    return bounds;
}

void pose(const scene::Instance& instance, const Part& part, const scene::Pose& pose, const Picked& picked, Posed& out) {
    const scene::Model& model = *instance.model;
    out.positions.clear();
    out.indices.clear();
    std::vector<glm::vec3> positions;
    for (const scene::Primitive& primitive : meshOf(model, part).primitives) {
        if (!picked(model, primitive)) continue;
        scene::deform(model, part.node, primitive, pose, positions, nullptr);
        const uint32_t first = uint32_t(out.positions.size());
        for (const glm::vec3& p : positions) out.positions.push_back(glm::vec3(instance.placement * glm::vec4(p, 1.0f)));
        for (const uint32_t index : primitive.indices) out.indices.push_back(first + index);
    }
}

}  // namespace obscura::voxel
