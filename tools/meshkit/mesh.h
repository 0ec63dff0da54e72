// Indexed triangle meshes: normals, texture coordinates, skinning weights, morph targets.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace obscura::kit {

struct Vertex {
    glm::vec3 position{0.0f};
    glm::vec3 normal{0.0f};
    glm::vec2 texcoord{0.0f};
};

struct Triangle {
    std::array<std::uint32_t, 3> corner{};
    std::uint32_t material = 0;
};

/// An indexed triangle mesh with counter-clockwise front faces. A material number is a slot: each
/// use of the mesh maps slots to materials of its own, so one shape serves many colours.
struct Mesh {
    std::vector<Vertex> vertices;
    std::vector<Triangle> triangles;

    std::uint32_t addVertex(glm::vec3 position, glm::vec2 texcoord = glm::vec2(0.0f));
    /// Triangles without area are left out, so shapes may collapse a ring to a pole.
    void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t material = 0);
    void addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, std::uint32_t material = 0);
    /// A quad with vertices of its own, for flat pieces.
    void addFace(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, std::uint32_t material = 0);
    void append(const Mesh& other, const glm::mat4& transform = glm::mat4(1.0f));
    void setMaterial(std::uint32_t material);
};

/// Gives each corner the area-weighted mean normal of the faces that meet there within the crease
/// angle; wider edges stay hard. Vertices are split and merged as needed.
void smoothNormals(Mesh& mesh, float creaseDegrees = 40.0f);

/// Texture coordinates in units of `metresPerTile`, projected along each face's main axis.
void boxMapTexcoords(Mesh& mesh, float metresPerTile);

/// Joints and weights of one vertex.
struct SkinInfluence {
    std::array<std::uint8_t, 4> joints{};
    glm::vec4 weights{0.0f};
};

/// Offsets from the base shape, one for each vertex.
struct MorphTarget {
    std::vector<glm::vec3> positionDeltas;
    std::vector<glm::vec3> normalDeltas;
};

/// A mesh with its skinning weights and morph targets.
struct Geometry {
    Mesh mesh;
    std::vector<SkinInfluence> skin;
    std::vector<MorphTarget> morphs;
};

/// The target that moves every point p to deform(p). Normals follow by the deformation's Jacobian,
/// so hard edges of the base shape stay hard.
MorphTarget makeMorph(const Mesh& mesh, const std::function<glm::vec3(glm::vec3)>& deform);

}  // namespace obscura::kit
