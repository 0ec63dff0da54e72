// Animation, skinning and morphing on the CPU.
#include "scene/pose.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_inverse.hpp>

namespace obscura::scene {
namespace {

glm::mat4 compose(const glm::vec3& translation, const glm::quat& rotation, const glm::vec3& scale) {
    const glm::mat3 axes = glm::mat3_cast(rotation);
    return {glm::vec4(axes[0] * scale.x, 0.0f), glm::vec4(axes[1] * scale.y, 0.0f), glm::vec4(axes[2] * scale.z, 0.0f),
        glm::vec4(translation, 1.0f)};
}

glm::quat quaternion(const float* xyzw) { return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]}; }

glm::quat unit(const glm::quat& q) {
    const float length = glm::length(q);
    return length > 1e-12f ? q / length : glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
}

// Writes channel.components values at `time`.
void sample(const Channel& channel, float time, float* out) {
    const size_t n = size_t(channel.components);
    const bool cubic = channel.interpolation == Interpolation::cubicSpline;
    const size_t stride = cubic ? 3 * n : n;
    const auto value = [&](size_t key) { return channel.values.data() + key * stride + (cubic ? n : 0); };
    const auto& times = channel.times;
    const size_t next = size_t(std::upper_bound(times.begin(), times.end(), time) - times.begin());
    if (next == 0 || next == times.size() || channel.interpolation == Interpolation::step) {
        std::copy_n(value(next == 0 ? 0 : next - 1), n, out);
        return;
    }
    const size_t key = next - 1;
    const float step = times[next] - times[key];
    const float t = (time - times[key]) / step;
    const float *a = value(key), *b = value(next);
    if (cubic) {  // glTF 2.0, appendix C.5
        const float t2 = t * t, t3 = t2 * t;
        for (size_t i = 0; i < n; ++i)
            out[i] = (2.0f * t3 - 3.0f * t2 + 1.0f) * a[i] + step * (t3 - 2.0f * t2 + t) * a[n + i] + (-2.0f * t3 + 3.0f * t2) * b[i] +
                     step * (t3 - t2) * (b - n)[i];
    } else if (channel.path == AnimatedPath::rotation) {
        const glm::quat q = glm::slerp(unit(quaternion(a)), unit(quaternion(b)), t);
        out[0] = q.x, out[1] = q.y, out[2] = q.z, out[3] = q.w;
    } else {
        for (size_t i = 0; i < n; ++i) out[i] = a[i] + t * (b[i] - a[i]);
    }
}

}  // namespace

std::vector<int> playing(const Model& model, int animation) {
    const size_t count = model.animations.size();
    if (animation != kAllAnimations) return animation >= 0 && size_t(animation) < count ? std::vector{animation} : std::vector<int>();
    if (count == 1) return {0};
    constexpr size_t kPaths = 4;
    std::vector<bool> moved(model.nodes.size() * kPaths, false);
    const auto target = [](const Channel& channel) { return size_t(channel.node) * kPaths + size_t(channel.path); };
    std::vector<int> list;
    for (size_t i = 0; i < count; ++i) {
        const std::vector<Channel>& channels = model.animations[i].channels;
        if (std::any_of(channels.begin(), channels.end(), [&](const Channel& channel) { return moved[target(channel)]; })) continue;
        for (const Channel& channel : channels) moved[target(channel)] = true;
        list.push_back(int(i));
    }
    return list;
}

Pose evaluate(const Model& model, int animation, float time, bool loop) {
    struct Local {
        glm::vec3 translation;
        glm::quat rotation;
        glm::vec3 scale;
    };
    const size_t count = model.nodes.size();
    Pose pose;
    pose.world.assign(count, glm::mat4(1.0f));
    pose.weights.resize(count);
    std::vector<Local> local(count);
    for (size_t i = 0; i < count; ++i) {
        const Node& node = model.nodes[i];
        local[i] = {node.translation, node.rotation, node.scale};
        if (node.mesh >= 0) {
            const Mesh& mesh = model.meshes[size_t(node.mesh)];
            if (!mesh.weights.empty()) pose.weights[i] = node.weights.empty() ? mesh.weights : node.weights;
        }
    }
    if (!std::isfinite(time)) time = 0.0f;
    for (const int index : playing(model, animation)) {
        const Animation& source = model.animations[size_t(index)];
        float at = time;
        if (loop && source.duration > 0.0f) {
            at = std::fmod(time, source.duration);
            if (at < 0.0f) at += source.duration;
        }
        for (const Channel& channel : source.channels) {
            Local& target = local[size_t(channel.node)];
            float value[4];
            if (channel.path == AnimatedPath::weights) {
                auto& weights = pose.weights[size_t(channel.node)];
                if (weights.size() == size_t(channel.components)) sample(channel, at, weights.data());
                continue;
            }
            sample(channel, at, value);
            if (channel.path == AnimatedPath::translation) target.translation = {value[0], value[1], value[2]};
            if (channel.path == AnimatedPath::rotation) target.rotation = unit(quaternion(value));
            if (channel.path == AnimatedPath::scale) target.scale = {value[0], value[1], value[2]};
        }
    }
    for (const int index : model.order) {
        const size_t i = size_t(index);
        const Node& node = model.nodes[i];
        const glm::mat4 own = node.hasMatrix ? node.matrix : compose(local[i].translation, local[i].rotation, local[i].scale);
        pose.world[i] = node.parent >= 0 ? pose.world[size_t(node.parent)] * own : own;
    }
    return pose;
}

std::vector<glm::mat4> jointMatrices(const Model& model, const Skin& skin, const Pose& pose) {
    std::vector<glm::mat4> matrices(skin.joints.size());
    for (size_t i = 0; i < matrices.size(); ++i) matrices[i] = pose.world[size_t(skin.joints[i])] * skin.inverseBindMatrices[i];
    return matrices;
}

void deform(const Model& model, int node, const Primitive& primitive, const Pose& pose, std::vector<glm::vec3>& positions,
    std::vector<glm::vec3>* normals) {
    positions = primitive.positions;
    if (normals != nullptr) *normals = primitive.normals;
    const auto& weights = pose.weights[size_t(node)];
    for (size_t t = 0; t < primitive.targets.size() && t < weights.size(); ++t) {
        if (weights[t] == 0.0f) continue;
        const Primitive::Target& target = primitive.targets[t];
        for (size_t i = 0; i < target.positions.size(); ++i) positions[i] += weights[t] * target.positions[i];
        if (normals != nullptr)
            for (size_t i = 0; i < target.normals.size(); ++i) (*normals)[i] += weights[t] * target.normals[i];
    }
    const auto transformed = [](const glm::mat3& cofactors, const glm::vec3& n) {
        const glm::vec3 out = cofactors * n;
        const float length = glm::length(out);
        return length > 0.0f ? out / length : n;
    };
    // The cofactor matrix instead of the inverse transpose: the same direction, and defined for a scale of 0. The inverse transpose also
    // divides by the determinant, hence the sign.
    const auto cofactors = [](const glm::mat3& m) {
        const float sign = glm::determinant(m) < 0.0f ? -1.0f : 1.0f;
        return sign * glm::mat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    };
    const int skin = model.nodes[size_t(node)].skin;
    if (skin >= 0 && !primitive.joints.empty()) {
        const std::vector<glm::mat4> joints = jointMatrices(model, model.skins[size_t(skin)], pose);
        for (size_t i = 0; i < positions.size(); ++i) {
            glm::mat4 blend(0.0f);
            for (size_t k = 0; k < size_t(Primitive::kInfluences); ++k)
                if (primitive.weights[i][k] != 0.0f) blend += primitive.weights[i][k] * joints[primitive.joints[i][k]];
            positions[i] = glm::vec3(blend * glm::vec4(positions[i], 1.0f));
            if (normals != nullptr) (*normals)[i] = transformed(cofactors(glm::mat3(blend)), (*normals)[i]);
        }
        return;
    }
    const glm::mat4& world = pose.world[size_t(node)];
    for (glm::vec3& p : positions) p = glm::vec3(world * glm::vec4(p, 1.0f));
    if (normals != nullptr) {
        const glm::mat3 normalMatrix = cofactors(glm::mat3(world));
        for (glm::vec3& n : *normals) n = transformed(normalMatrix, n);
    }
}

}  // namespace obscura::scene
