#include "meshkit/mesh.h"

#include <cmath>
#include <map>
#include <tuple>

namespace obscura::kit {

namespace {

using Cell = std::tuple<long, long, long>;

/// Points closer than a twentieth of a millimetre count as one when normals are averaged.
Cell cellOf(glm::vec3 p) {
    constexpr float kCellsPerMetre = 20000.0f;
    return {std::lround(p.x * kCellsPerMetre), std::lround(p.y * kCellsPerMetre), std::lround(p.z * kCellsPerMetre)};
}

glm::vec3 areaVector(const Mesh& mesh, const Triangle& triangle) {
    const glm::vec3 a = mesh.vertices[triangle.corner[0]].position;
    const glm::vec3 b = mesh.vertices[triangle.corner[1]].position;
    const glm::vec3 c = mesh.vertices[triangle.corner[2]].position;
    return glm::cross(b - a, c - a);
}

}  // namespace

std::uint32_t Mesh::addVertex(glm::vec3 position, glm::vec2 texcoord) {
    vertices.push_back({position, glm::vec3(0.0f), texcoord});
    return static_cast<std::uint32_t>(vertices.size() - 1);
}

void Mesh::addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t material) {
    const Triangle triangle{{a, b, c}, material};
    constexpr float kSmallestArea = 1e-10f;
    if (glm::length(areaVector(*this, triangle)) > kSmallestArea) triangles.push_back(triangle);
}

void Mesh::addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, std::uint32_t material) {
    addTriangle(a, b, c, material);
    addTriangle(a, c, d, material);
}

void Mesh::addFace(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, std::uint32_t material) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (glm::vec3 p : {a, b, c, d}) addVertex(p);
    addQuad(first, first + 1, first + 2, first + 3, material);
}

void Mesh::append(const Mesh& other, const glm::mat4& transform) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    const glm::mat3 linear(transform);
    const glm::mat3 normalMatrix = glm::transpose(glm::inverse(linear));
    const bool mirrored = glm::determinant(linear) < 0.0f;
    for (Vertex vertex : other.vertices) {
        vertex.position = glm::vec3(transform * glm::vec4(vertex.position, 1.0f));
        if (vertex.normal != glm::vec3(0.0f)) vertex.normal = glm::normalize(normalMatrix * vertex.normal);
        vertices.push_back(vertex);
    }
    for (Triangle triangle : other.triangles) {
        for (std::uint32_t& corner : triangle.corner) corner += first;
        if (mirrored) std::swap(triangle.corner[1], triangle.corner[2]);
        triangles.push_back(triangle);
    }
}

void Mesh::setMaterial(std::uint32_t material) {
    for (Triangle& triangle : triangles) triangle.material = material;
}

void smoothNormals(Mesh& mesh, float creaseDegrees) {
    const float smallestCosine = std::cos(glm::radians(creaseDegrees));
    std::vector<glm::vec3> areas(mesh.triangles.size());
    std::map<Cell, std::vector<std::size_t>> facesAt;
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
        areas[face] = areaVector(mesh, mesh.triangles[face]);
        for (std::uint32_t corner : mesh.triangles[face].corner) facesAt[cellOf(mesh.vertices[corner].position)].push_back(face);
    }

    using Key = std::tuple<Cell, float, float, float, float, float>;
    std::map<Key, std::uint32_t> known;
    std::vector<Vertex> vertices;
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
        const glm::vec3 own = glm::normalize(areas[face]);
        for (std::uint32_t& corner : mesh.triangles[face].corner) {
            Vertex vertex = mesh.vertices[corner];
            const Cell cell = cellOf(vertex.position);
            glm::vec3 sum(0.0f);
            for (std::size_t other : facesAt[cell])
                if (glm::dot(own, glm::normalize(areas[other])) > smallestCosine) sum += areas[other];
            vertex.normal = glm::normalize(sum);
            const Key key{cell, vertex.normal.x, vertex.normal.y, vertex.normal.z, vertex.texcoord.x, vertex.texcoord.y};
            const auto [entry, isNew] = known.try_emplace(key, static_cast<std::uint32_t>(vertices.size()));
            if (isNew) vertices.push_back(vertex);
            corner = entry->second;
        }
    }
    mesh.vertices = std::move(vertices);
}

void boxMapTexcoords(Mesh& mesh, float metresPerTile) {
    std::vector<Vertex> vertices;
    for (Triangle& triangle : mesh.triangles) {
        const glm::vec3 size = glm::abs(areaVector(mesh, triangle));
        for (std::uint32_t& corner : triangle.corner) {
            Vertex vertex = mesh.vertices[corner];
            const glm::vec3 p = vertex.position / metresPerTile;
            if (size.y >= size.x && size.y >= size.z) vertex.texcoord = {p.x, p.z};
            else if (size.x >= size.z) vertex.texcoord = {p.z, -p.y};
            else vertex.texcoord = {p.x, -p.y};
            corner = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(vertex);
        }
    }
    mesh.vertices = std::move(vertices);
}

MorphTarget makeMorph(const Mesh& mesh, const std::function<glm::vec3(glm::vec3)>& deform) {
    constexpr float kStep = 1e-3f;
    MorphTarget target;
    for (const Vertex& vertex : mesh.vertices) {
        const glm::vec3 p = vertex.position;
        glm::mat3 jacobian;
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 step(0.0f);
            step[axis] = kStep;
            jacobian[axis] = (deform(p + step) - deform(p - step)) / (2.0f * kStep);
        }
        const glm::vec3 normal = glm::normalize(glm::transpose(glm::inverse(jacobian)) * vertex.normal);
        target.positionDeltas.push_back(deform(p) - p);
        target.normalDeltas.push_back(normal - vertex.normal);
    }
    return target;
}

}  // namespace obscura::kit
