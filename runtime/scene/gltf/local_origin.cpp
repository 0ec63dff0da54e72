// Files in map coordinates place a scene thousands of kilometres from their origin, where a float resolves half a metre. Such a scene is
// moved in double precision: each chain of nodes loses the distance at the node that adds it, so that all later products are of small
// numbers.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <tiny_gltf.h>
#include <glm/gtc/quaternion.hpp>

#include "scene/gltf/stages.h"

namespace obscura::scene::gltf {
namespace {

// Beyond this many radii from the origin a float's step is 1e-5 of the radius.
constexpr double kFar = 150.0;

glm::dmat4 localOf(const tinygltf::Node& node) {
    glm::dmat4 local(1.0);
    if (!node.matrix.empty()) {
        for (int i = 0; i < 16; ++i) local[i / 4][i % 4] = node.matrix[size_t(i)];
        return local;
    }
    if (!node.rotation.empty())
        local = glm::mat4_cast(glm::normalize(glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2])));
    if (!node.scale.empty())
        for (int i = 0; i < 3; ++i) local[i] *= node.scale[size_t(i)];
    if (!node.translation.empty()) local[3] = glm::dvec4(node.translation[0], node.translation[1], node.translation[2], 1.0);
    return local;
}

struct Box {
    glm::dvec3 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
    void add(const glm::dvec3& p) { min = glm::min(min, p), max = glm::max(max, p); }
};

// Of the meshes at rest; skinned ones are where their nodes are, which is near enough.
Box boundsOf(const Model& model, const std::vector<glm::dmat4>& locals) {
    std::vector<glm::dmat4> world = locals;
    Box box;
    for (const int index : model.order) {
        const Node& node = model.nodes[size_t(index)];
        if (node.parent >= 0) world[size_t(index)] = world[size_t(node.parent)] * locals[size_t(index)];
        if (node.mesh < 0) continue;
        for (const Primitive& primitive : model.meshes[size_t(node.mesh)].primitives) {
            if (primitive.indices.empty()) continue;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::vec3 at(corner & 1 ? primitive.boundsMax.x : primitive.boundsMin.x,
                    corner & 2 ? primitive.boundsMax.y : primitive.boundsMin.y, corner & 4 ? primitive.boundsMax.z : primitive.boundsMin.z);
                box.add(glm::dvec3(world[size_t(index)] * glm::dvec4(glm::dvec3(at), 1.0)));
            }
        }
    }
    return box;
}

}  // namespace

void moveToLocalOrigin(Context& context, const Asset& asset, Model& model) {
    std::vector<glm::dmat4> locals;
    for (const tinygltf::Node& node : asset.gltf->nodes) locals.push_back(localOf(node));
    const Box box = boundsOf(model, locals);
    const glm::dvec3 centre = 0.5 * (box.min + box.max);
    const double radius = 0.5 * glm::length(box.max - box.min);
    if (!std::isfinite(glm::length(centre)) || !std::isfinite(radius)) return;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(centre[axis]) > kFar * radius) model.origin[axis] = std::round(centre[axis]);
    if (radius <= 0.0 || model.origin == glm::dvec3(0.0)) {
        model.origin = glm::dvec3(0.0);
        return;
    }

    // The distance that a node's content must lose, in its parent's space; parents come before children.
    std::vector<glm::dvec3> pending(model.nodes.size(), glm::dvec3(0.0));
    context.shifts.assign(model.nodes.size(), glm::dvec3(0.0));
    for (const int root : model.roots) pending[size_t(root)] = model.origin;
    for (const int index : model.order) {
        const size_t i = size_t(index);
        Node& node = model.nodes[i];
        const glm::dvec3 at(locals[i][3]), by = pending[i];
        const glm::dmat3 axes(locals[i]);
        const bool hasContent = node.mesh >= 0 || node.camera >= 0 || node.children.empty();
        const bool addsIt = glm::length(at - by) <= 0.5 * glm::length(by);
        if (by == glm::dvec3(0.0)) continue;
        if (hasContent || addsIt || std::abs(glm::determinant(axes)) < 1e-300) {
            context.shifts[i] = by;
            if (node.hasMatrix) node.matrix[3] = glm::vec4(glm::vec3(at - by), 1.0f);
            else node.translation = glm::vec3(at - by);
        } else {
            for (const int child : node.children) pending[size_t(child)] = glm::inverse(axes) * by;
        }
    }
    context.warn("", fmt::format("the scene lies {:.0f} units from the file's origin; it is moved there from ({:.0f}, {:.0f}, {:.0f}), in "
                                 "double precision",
                         glm::length(centre), model.origin.x, model.origin.y, model.origin.z));
}

}  // namespace obscura::scene::gltf
