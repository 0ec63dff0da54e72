// The scene of a content generator, after glTF's model: materials, meshes, nodes, skins, cameras, one animation.
#pragma once

#include "meshkit/image.h"
#include "meshkit/mesh.h"

#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <vector>

namespace obscura::kit {

constexpr int kNone = -1;

/// Base colours are linear, as in glTF.
struct Material {
    std::string name;
    glm::vec4 baseColor{1.0f};
    float metallic = 0.0f;
    float roughness = 0.8f;
    int image = kNone;
    bool masked = false;
    bool doubleSided = false;
    glm::vec3 emissive{0.0f};
};

struct NamedImage {
    std::string name;
    Image image;
};

/// A use of a geometry with materials for its slots.
struct MeshUse {
    std::string name;
    int geometry = kNone;
    std::vector<int> materials;
};

struct Camera {
    std::string name;
    float verticalFov = 0.9f;
    float nearPlane = 0.05f;
};

struct Skin {
    std::string name;
    int skeletonRoot = kNone;
    std::vector<int> joints;
    std::vector<glm::mat4> inverseBind;
};

struct Node {
    std::string name;
    int parent = kNone;
    glm::vec3 translation{0.0f};
    glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
    glm::vec3 scale{1.0f};
    int mesh = kNone;
    int skin = kNone;
    int camera = kNone;
};

enum class Path { Translation, Rotation, Scale, Weights };
enum class Interpolation { Linear, Step, CubicSpline };

/// Keys of one animated property; cubic keys hold in-tangent, value, out-tangent in turn.
/// Rotations are stored x, y, z, w.
struct Channel {
    int node = kNone;
    Path path = Path::Translation;
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times;
    std::vector<float> values;
};

struct Scene {
    std::string name;
    std::string animation;
    std::vector<NamedImage> images;
    std::vector<Material> materials;
    std::vector<Geometry> geometries;
    std::vector<MeshUse> meshes;
    std::vector<Camera> cameras;
    std::vector<Skin> skins;
    std::vector<Node> nodes;
    std::vector<Channel> channels;

    int addImage(std::string imageName, Image image);
    int addMaterial(Material material);
    int addGeometry(Geometry geometry);
    int addMesh(std::string meshName, int geometry, std::vector<int> meshMaterials);
    int addNode(Node node);
    int addSkin(Skin skin);
    /// A camera node that stands at `eye` and looks at `target`.
    int addCamera(Camera camera, glm::vec3 eye, glm::vec3 target);
    int findNode(const std::string& nodeName) const;
    /// Number of floats in one value of a channel: 3, 4, or the node's count of morph targets.
    std::size_t channelWidth(const Channel& channel) const;
    /// Triangles as drawn: a shared mesh counts once for each node that shows it.
    std::size_t triangleCount() const;

    void animateTranslation(int node, const std::vector<float>& times, const std::function<glm::vec3(float)>& at);
    /// Neighbouring quaternions are kept in one half of the sphere.
    void animateRotation(int node, const std::vector<float>& times, const std::function<glm::quat(float)>& at,
        Interpolation interpolation = Interpolation::Linear);
    void animateWeights(int node, const std::vector<float>& times, const std::function<std::vector<float>(float)>& at);
};

/// 0, 1/rate, 2/rate .. duration.
std::vector<float> sampleTimes(float duration, float rate);

/// The linear colour of an sRGB one given as 0xRRGGBB.
glm::vec4 srgb(std::uint32_t hex);

}  // namespace obscura::kit
