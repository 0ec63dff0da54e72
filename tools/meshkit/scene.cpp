#include "meshkit/scene.h"

#include <cmath>
#include <stdexcept>

namespace obscura::kit {

namespace {

template <typename T>
int store(std::vector<T>& list, T item) {
    list.push_back(std::move(item));
    return static_cast<int>(list.size() - 1);
}

}  // namespace

int Scene::addImage(std::string imageName, Image image) { return store(images, NamedImage{std::move(imageName), std::move(image)}); }

int Scene::addMaterial(Material material) { return store(materials, std::move(material)); }

int Scene::addGeometry(Geometry geometry) { return store(geometries, std::move(geometry)); }

int Scene::addMesh(std::string meshName, int geometry, std::vector<int> meshMaterials) {
    return store(meshes, MeshUse{std::move(meshName), geometry, std::move(meshMaterials)});
}

int Scene::addNode(Node node) { return store(nodes, std::move(node)); }

int Scene::addSkin(Skin skin) { return store(skins, std::move(skin)); }

int Scene::addCamera(Camera camera, glm::vec3 eye, glm::vec3 target) {
    Node node;
    node.name = camera.name;
    node.translation = eye;
    node.rotation = glm::quatLookAt(glm::normalize(target - eye), glm::vec3(0.0f, 1.0f, 0.0f));
    node.camera = store(cameras, std::move(camera));
    return addNode(node);
}

int Scene::findNode(const std::string& nodeName) const {
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].name == nodeName) return static_cast<int>(i);
    return kNone;
}

std::size_t Scene::channelWidth(const Channel& channel) const {
    switch (channel.path) {
        case Path::Translation:
        case Path::Scale: return 3;
        case Path::Rotation: return 4;
        case Path::Weights: return geometries[meshes[nodes[channel.node].mesh].geometry].morphs.size();
    }
    throw std::logic_error("unknown animation path");
}

std::size_t Scene::triangleCount() const {
    std::size_t count = 0;
    for (const Node& node : nodes)
        if (node.mesh != kNone) count += geometries[meshes[node.mesh].geometry].mesh.triangles.size();
    return count;
}

void Scene::animateTranslation(int node, const std::vector<float>& times, const std::function<glm::vec3(float)>& at) {
    Channel channel{node, Path::Translation, Interpolation::Linear, times, {}};
    for (float time : times) {
        const glm::vec3 v = at(time);
        channel.values.insert(channel.values.end(), {v.x, v.y, v.z});
    }
    channels.push_back(std::move(channel));
}

void Scene::animateRotation(
    int node, const std::vector<float>& times, const std::function<glm::quat(float)>& at, Interpolation interpolation) {
    Channel channel{node, Path::Rotation, interpolation, times, {}};
    glm::quat last(1.0f, 0.0f, 0.0f, 0.0f);
    for (float time : times) {
        glm::quat q = glm::normalize(at(time));
        if (time != times.front() && glm::dot(q, last) < 0.0f) q = -q;
        last = q;
        channel.values.insert(channel.values.end(), {q.x, q.y, q.z, q.w});
    }
    channels.push_back(std::move(channel));
}

void Scene::animateWeights(int node, const std::vector<float>& times, const std::function<std::vector<float>(float)>& at) {
    Channel channel{node, Path::Weights, Interpolation::Linear, times, {}};
    for (float time : times) {
        const std::vector<float> weights = at(time);
        channel.values.insert(channel.values.end(), weights.begin(), weights.end());
    }
    channels.push_back(std::move(channel));
}

std::vector<float> sampleTimes(float duration, float rate) {
    std::vector<float> times;
    const int count = static_cast<int>(std::lround(duration * rate));
    for (int i = 0; i <= count; ++i) times.push_back(duration * static_cast<float>(i) / static_cast<float>(count));
    return times;
}

glm::vec4 srgb(std::uint32_t hex) {
    const auto linear = [&](int shift) {
        const float c = static_cast<float>((hex >> shift) & 0xFFu) / 255.0f;
        return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
    };
    return {linear(16), linear(8), linear(0), 1.0f};
}

}  // namespace obscura::kit
