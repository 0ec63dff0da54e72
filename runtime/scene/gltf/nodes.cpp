// glTF nodes, skins and cameras; roots and node order of the selected scene.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tiny_gltf.h>
#include <glm/gtc/type_ptr.hpp>

#include "scene/gltf/stages.h"

namespace obscura::scene::gltf {
namespace {

// Decomposes a matrix into translation, rotation and scale. False if it has shear, projection or a scale of 0. Mirroring becomes a negative
// x scale.
bool decompose(const glm::mat4& matrix, Node& node) {
    if (matrix[0].w != 0.0f || matrix[1].w != 0.0f || matrix[2].w != 0.0f || matrix[3].w != 1.0f) return false;
    glm::mat3 axes(matrix);
    glm::vec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
    if (!(std::min({scale.x, scale.y, scale.z}) > 1e-12f) || !std::isfinite(scale.x + scale.y + scale.z)) return false;
    if (glm::determinant(axes) < 0.0f) scale.x = -scale.x;
    for (int i = 0; i < 3; ++i) axes[i] /= scale[i];
    const float skew =
        std::max({std::abs(glm::dot(axes[0], axes[1])), std::abs(glm::dot(axes[1], axes[2])), std::abs(glm::dot(axes[2], axes[0]))});
    if (skew > 1e-4f) return false;
    node.translation = glm::vec3(matrix[3]);
    node.rotation = glm::normalize(glm::quat_cast(axes));
    node.scale = scale;
    return true;
}

Node nodeOf(Context& context, const tinygltf::Node& from, const std::string& pointer) {
    Node node;
    node.name = from.name;
    node.children = from.children;
    node.mesh = from.mesh;
    node.skin = from.skin;
    node.camera = from.camera;
    if (!from.matrix.empty()) {
        glm::mat4 matrix;
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = float(from.matrix[size_t(i)]);
        if (!decompose(matrix, node)) {
            node.hasMatrix = true;
            node.matrix = matrix;
        }
    }
    if (!from.translation.empty())
        for (int i = 0; i < 3; ++i) node.translation[i] = float(from.translation[size_t(i)]);
    if (!from.scale.empty())
        for (int i = 0; i < 3; ++i) node.scale[i] = float(from.scale[size_t(i)]);
    if (!from.rotation.empty()) {
        glm::dvec4 q(from.rotation[0], from.rotation[1], from.rotation[2], from.rotation[3]);
        const double length = glm::length(q);
        if (std::abs(length - 1.0) > 1e-3)
            context.warn(pointer + "/rotation", fmt::format("quaternion of length {}, normalized to 1", length));
        q /= length;
        node.rotation = glm::quat(float(q.w), float(q.x), float(q.y), float(q.z));
    }
    for (const double weight : from.weights) node.weights.push_back(float(weight));
    return node;
}

Lens lensOf(Context& context, const tinygltf::Camera& from, const std::string& pointer) {
    Lens lens;
    lens.name = from.name;
    lens.perspective = from.type == "perspective";
    if (lens.perspective) {
        constexpr float kMaxFov = 2.967f;  // 170 degrees
        lens.fovY = float(from.perspective.yfov);
        if (lens.fovY > kMaxFov) {
            context.warn(pointer, fmt::format("field of view of {} radians, reduced to {}", lens.fovY, kMaxFov));
            lens.fovY = kMaxFov;
        }
        lens.aspect = float(from.perspective.aspectRatio);
        lens.nearPlane = float(from.perspective.znear);
        lens.farPlane = float(from.perspective.zfar);
    } else {
        lens.halfHeight = std::abs(float(from.orthographic.ymag));
        lens.aspect = std::abs(float(from.orthographic.xmag / from.orthographic.ymag));
        lens.nearPlane = float(from.orthographic.znear);
        lens.farPlane = float(from.orthographic.zfar);
    }
    return lens;
}

Skin skinOf(Context& context, const Asset& asset, const tinygltf::Skin& from) {
    Skin skin;
    skin.name = from.name;
    skin.joints = from.joints;
    skin.inverseBindMatrices.assign(skin.joints.size(), glm::mat4(1.0f));
    if (from.inverseBindMatrices >= 0) {
        const std::vector<float> values = readFloats(context, asset, from.inverseBindMatrices);
        for (size_t i = 0; i < skin.joints.size(); ++i) skin.inverseBindMatrices[i] = glm::make_mat4(values.data() + i * 16);
    }
    return skin;
}

void chooseScene(Context& context, const tinygltf::Model& gltf, int scene, Model& model) {
    if (scene >= int(gltf.scenes.size()))
        context.fail("/scenes", fmt::format("scene {} does not exist: there are {}, counted from 0", scene, gltf.scenes.size()));
    if (scene < 0) scene = gltf.defaultScene >= 0 ? gltf.defaultScene : 0;
    if (size_t(scene) < gltf.scenes.size()) {
        model.roots = gltf.scenes[size_t(scene)].nodes;
    } else {  // without scenes: all root nodes
        for (size_t i = 0; i < model.nodes.size(); ++i)
            if (model.nodes[i].parent < 0) model.roots.push_back(int(i));
    }
    // Depth first without recursion: a chain of nodes can be too long for the call stack.
    std::vector<int> stack(model.roots.rbegin(), model.roots.rend());
    while (!stack.empty()) {
        const int node = stack.back();
        stack.pop_back();
        model.order.push_back(node);
        const auto& children = model.nodes[size_t(node)].children;
        stack.insert(stack.end(), children.rbegin(), children.rend());
    }
}

}  // namespace

void addNodes(Context& context, const Asset& asset, int scene, Model& model) {
    const tinygltf::Model& gltf = *asset.gltf;
    for (size_t i = 0; i < gltf.nodes.size(); ++i) model.nodes.push_back(nodeOf(context, gltf.nodes[i], fmt::format("/nodes/{}", i)));
    for (size_t i = 0; i < model.nodes.size(); ++i)
        for (const int child : model.nodes[i].children) model.nodes[size_t(child)].parent = int(i);
    for (size_t i = 0; i < gltf.cameras.size(); ++i)
        model.lenses.push_back(lensOf(context, gltf.cameras[i], fmt::format("/cameras/{}/perspective/yfov", i)));
    for (const auto& skin : gltf.skins) model.skins.push_back(skinOf(context, asset, skin));
    chooseScene(context, gltf, scene, model);
    std::vector<bool> reached(model.nodes.size(), false);
    for (const int node : model.order) reached[size_t(node)] = true;
    for (size_t i = 0; i < model.skins.size(); ++i)
        for (const int joint : model.skins[i].joints)
            if (!reached[size_t(joint)]) {
                context.warn(
                    fmt::format("/skins/{}/joints", i), fmt::format("joint node {} is not in the scene; it stays at the origin", joint));
                break;
            }
}

}  // namespace obscura::scene::gltf
