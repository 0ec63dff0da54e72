#include "meshkit/pose.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

namespace obscura::kit {

namespace {

glm::quat quaternion(const float* v) { return glm::quat(v[3], v[0], v[1], v[2]); }

}  // namespace

std::vector<float> valueAt(const Scene& scene, const Channel& channel, float time) {
    const std::size_t width = scene.channelWidth(channel);
    const auto after = std::upper_bound(channel.times.begin(), channel.times.end(), time);
    const std::size_t last = channel.times.size() - 1;
    const auto b = std::min(static_cast<std::size_t>(after - channel.times.begin()), last);
    const std::size_t a = b > 0 && time < channel.times[b] ? b - 1 : b;
    const float span = channel.times[b] - channel.times[a];
    const float u = span > 0.0f ? std::max(0.0f, (time - channel.times[a]) / span) : 0.0f;

    const bool cubic = channel.interpolation == Interpolation::CubicSpline;
    const float* from = &channel.values[(cubic ? a * 3 + 1 : a) * width];
    const float* to = &channel.values[(cubic ? b * 3 + 1 : b) * width];
    std::vector<float> result(from, from + width);
    if (cubic) {
        const float u2 = u * u;
        const float u3 = u2 * u;
        for (std::size_t i = 0; i < width; ++i)
            result[i] = (2 * u3 - 3 * u2 + 1) * from[i] + (u3 - 2 * u2 + u) * span * from[i + width] + (3 * u2 - 2 * u3) * to[i] +
                        (u3 - u2) * span * channel.values[b * 3 * width + i];
    } else if (channel.interpolation == Interpolation::Linear) {
        for (std::size_t i = 0; i < width; ++i) result[i] = glm::mix(from[i], to[i], u);
    }
    if (channel.path == Path::Rotation) {
        glm::quat q = quaternion(result.data());
        if (channel.interpolation == Interpolation::Linear) q = glm::slerp(quaternion(from), quaternion(to), u);
        q = glm::normalize(q);
        result = {q.x, q.y, q.z, q.w};
    }
    return result;
}

Pose poseAt(const Scene& scene, float time) {
    std::vector<Node> nodes = scene.nodes;
    Pose pose;
    pose.weights.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].mesh != kNone) pose.weights[i].assign(scene.geometries[scene.meshes[nodes[i].mesh].geometry].morphs.size(), 0.0f);
    for (const Channel& channel : scene.channels) {
        const std::vector<float> value = valueAt(scene, channel, time);
        Node& node = nodes[channel.node];
        switch (channel.path) {
            case Path::Translation: node.translation = {value[0], value[1], value[2]}; break;
            case Path::Rotation: node.rotation = quaternion(value.data()); break;
            case Path::Scale: node.scale = {value[0], value[1], value[2]}; break;
            case Path::Weights: pose.weights[channel.node] = value; break;
        }
    }
    // Parents are always added before their children.
    for (const Node& node : nodes) {
        const glm::mat4 local =
            glm::translate(glm::mat4(1.0f), node.translation) * glm::mat4_cast(node.rotation) * glm::scale(glm::mat4(1.0f), node.scale);
        pose.world.push_back(node.parent == kNone ? local : pose.world[node.parent] * local);
    }
    return pose;
}

std::vector<glm::vec3> posedPositions(const Scene& scene, const Pose& pose, int node) {
    const Node& shown = scene.nodes[node];
    const Geometry& geometry = scene.geometries[scene.meshes[shown.mesh].geometry];
    std::vector<glm::vec3> result;
    for (std::size_t i = 0; i < geometry.mesh.vertices.size(); ++i) {
        glm::vec3 p = geometry.mesh.vertices[i].position;
        for (std::size_t m = 0; m < geometry.morphs.size(); ++m) p += pose.weights[node][m] * geometry.morphs[m].positionDeltas[i];
        glm::mat4 matrix = pose.world[node];
        if (shown.skin != kNone) {
            const Skin& skin = scene.skins[shown.skin];
            matrix = glm::mat4(0.0f);
            for (int k = 0; k < 4; ++k) {
                const int joint = geometry.skin[i].joints[k];
                matrix += geometry.skin[i].weights[k] * pose.world[skin.joints[joint]] * skin.inverseBind[joint];
            }
        }
        result.emplace_back(matrix * glm::vec4(p, 1.0f));
    }
    return result;
}

}  // namespace obscura::kit
