// A glTF model as plain data on the CPU. The loader fills it; pose, renderer, voxels and references read it. Immutable once loaded, shared
// by std::shared_ptr<const Model>. Right-handed, y up, metres, as in glTF. Indices are -1 for "none".
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace obscura::scene {

enum class Wrap : uint8_t { repeat, mirror, clamp };

struct Sampler {
    Wrap wrapU = Wrap::repeat;
    Wrap wrapV = Wrap::repeat;
    bool linearMag = true;
    bool linearMin = true;
    bool mipmaps = true;
};

// 8-bit RGBA, rows top to bottom, tightly packed. `srgb` follows from the image's use in materials (colour or data).
struct Image {
    std::string name;
    uint32_t width = 0;
    uint32_t height = 0;
    bool srgb = false;
    std::vector<uint8_t> rgba;
};

struct Texture {
    int image = -1;
    Sampler sampler;
};

// A use of a texture by a material. uv' = rotation(uv * scale) + offset [KHR_texture_transform].
struct TextureUse {
    int texture = -1;
    int texCoord = 0;  // 0 or 1
    glm::vec2 offset{0.0f};
    glm::vec2 scale{1.0f};
    float rotation = 0.0f;  // radians, counter-clockwise as the extension defines it
};

enum class AlphaMode : uint8_t { opaque, mask, blend };

// How depth layers treat triangles. solid: closed, front faces outside; flipped: closed, wound the other way round; sheet: open, without an
// inside.
enum class Shell : uint8_t { solid, flipped, sheet };

struct Material {
    std::string name;
    glm::vec4 baseColor{1.0f};  // linear
    float metallic = 1.0f;
    float roughness = 1.0f;
    glm::vec3 emission{0.0f};  // linear, emissive strength included
    float normalScale = 1.0f;
    float occlusionStrength = 1.0f;
    float alphaCutoff = 0.5f;
    AlphaMode alphaMode = AlphaMode::opaque;
    bool doubleSided = false;
    bool unlit = false;
    Shell shell = Shell::solid;
    TextureUse baseColorTexture;
    TextureUse metallicRoughnessTexture;
    TextureUse normalTexture;
    TextureUse emissionTexture;
    TextureUse occlusionTexture;
};

// One set of triangles with one material. Every attribute array has the same length as `positions` or is empty where
// noted. Triangle lists only: strips and fans are unrolled, points and lines dropped by the loader.
struct Primitive {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;   // unit; generated (flat) when the file has none
    std::vector<glm::vec4> tangents;  // xyz unit, w = +-1; generated when missing
    std::vector<glm::vec2> uv0;       // zero-filled when missing
    std::vector<glm::vec2> uv1;       // empty when missing
    std::vector<glm::vec4> colors;    // empty when missing; linear
    std::vector<uint32_t> indices;    // 3 per triangle, each < positions.size()

    static constexpr int kInfluences = 8;
    std::vector<std::array<uint16_t, kInfluences>> joints;  // empty when not skinned; index into Skin::joints
    std::vector<std::array<float, kInfluences>> weights;    // sum 1

    struct Target {  // displacements; empty arrays mean zero
        std::vector<glm::vec3> positions;
        std::vector<glm::vec3> normals;
        std::vector<glm::vec3> tangents;
    };
    std::vector<Target> targets;  // as many as Mesh::weights
    int material = 0;             // always valid: the loader appends a default material where needed
    glm::vec3 boundsMin{0.0f};    // of positions, targets at full weight included
    glm::vec3 boundsMax{0.0f};
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<float> weights;  // default morph weights
};

struct Skin {
    std::string name;
    std::vector<int> joints;                     // node indices
    std::vector<glm::mat4> inverseBindMatrices;  // one per joint
};

// A node and its local transform. Matrices are decomposed where possible, else kept in `matrix` (hasMatrix).
struct Node {
    std::string name;
    int parent = -1;
    std::vector<int> children;
    glm::vec3 translation{0.0f};
    glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
    glm::vec3 scale{1.0f};
    bool hasMatrix = false;
    glm::mat4 matrix{1.0f};
    int mesh = -1;
    int skin = -1;
    int camera = -1;
    std::vector<float> weights;  // overrides Mesh::weights when not empty
};

struct Lens {
    std::string name;
    bool perspective = true;
    float fovY = 1.0471976f;  // radians, perspective only
    float halfHeight = 1.0f;  // metres, orthographic only
    float aspect = 0.0f;      // 0: the window's
    float nearPlane = 0.05f;  // metres; orthographic: may be 0
    float farPlane = 0.0f;    // metres; 0: at infinity
};

enum class Interpolation : uint8_t { step, linear, cubicSpline };
enum class AnimatedPath : uint8_t { translation, rotation, scale, weights };

struct Channel {
    int node = -1;
    AnimatedPath path = AnimatedPath::translation;
    Interpolation interpolation = Interpolation::linear;
    int components = 3;         // 3, 4 (quaternion xyzw) or the number of morph weights
    std::vector<float> times;   // seconds, strictly increasing, at least one
    std::vector<float> values;  // times.size() * components, three times that for cubicSpline (in, value, out)
};

struct Animation {
    std::string name;
    float duration = 0.0f;  // seconds, last key of any channel
    std::vector<Channel> channels;
};

// An extension that the file lists as used.
struct Extension {
    std::string name;
    bool read = false;  // false: ignored
};

struct Model {
    std::string name;   // file stem
    uint64_t hash = 0;  // of the bytes of all files read, and of the scene index
    std::vector<Image> images;
    std::vector<Texture> textures;
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Skin> skins;
    std::vector<Node> nodes;
    std::vector<int> roots;    // of the chosen scene
    std::vector<int> order;    // nodes reachable from roots, parents before children
    std::vector<Lens> lenses;  // glTF cameras
    std::vector<Animation> animations;
    glm::dvec3 origin{0.0};             // of model space in the file's space; not 0 for a scene far from the file's origin
    std::vector<Extension> extensions;  // in the file's order
    std::vector<std::string> variants;  // names of KHR_materials_variants, which are ignored
    std::vector<std::string> warnings;  // one line each: what was ignored, repaired or moved

    size_t triangleCount() const;  // of all meshes as instanced by nodes in `order`
};

}  // namespace obscura::scene
