// Generates data that files lack: flat normals, tangents, bounds.
#include <algorithm>
#include <cmath>

#include "scene/gltf/stages.h"

namespace obscura::scene::gltf {
namespace {

glm::vec3 unitOr(const glm::vec3& v, const glm::vec3& otherwise) {
    const float length = glm::length(v);
    return length > 1e-20f && std::isfinite(length) ? v / length : otherwise;
}

// Any unit vector at right angles to n, without a branch cut near the poles [Duff et al. 2017].
glm::vec3 perpendicular(const glm::vec3& n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    return {1.0f + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

template <class T>
void unshare(std::vector<T>& values, const std::vector<uint32_t>& indices) {
    if (values.empty()) return;
    std::vector<T> out(indices.size());
    for (size_t i = 0; i < indices.size(); ++i) out[i] = values[indices[i]];
    values = std::move(out);
}

}  // namespace

void addFlatNormals(Primitive& primitive) {
    unshare(primitive.positions, primitive.indices);
    unshare(primitive.uv0, primitive.indices);
    unshare(primitive.uv1, primitive.indices);
    unshare(primitive.colors, primitive.indices);
    unshare(primitive.joints, primitive.indices);
    unshare(primitive.weights, primitive.indices);
    for (Primitive::Target& target : primitive.targets) {
        unshare(target.positions, primitive.indices);
        target.normals.clear();  // displacements of normals that the file does not have [glTF 2.0, 3.7.2.2]
        target.tangents.clear();
    }
    for (size_t i = 0; i < primitive.indices.size(); ++i) primitive.indices[i] = uint32_t(i);
    const auto faceNormal = [&](size_t first, const Primitive::Target* target) {
        glm::vec3 p[3];
        for (size_t k = 0; k < 3; ++k) {
            p[k] = primitive.positions[first + k];
            if (target != nullptr) p[k] += target->positions[first + k];
        }
        return unitOr(glm::cross(p[1] - p[0], p[2] - p[0]), glm::vec3(0.0f, 1.0f, 0.0f));
    };
    primitive.normals.resize(primitive.positions.size());
    for (size_t i = 0; i + 2 < primitive.positions.size(); i += 3)
        std::fill_n(primitive.normals.begin() + ptrdiff_t(i), 3, faceNormal(i, nullptr));
    // Morphing turns flat faces. The displacement to the target's face normal is exact at weights 0 and 1.
    for (Primitive::Target& target : primitive.targets) {
        if (target.positions.empty()) continue;
        target.normals.resize(primitive.positions.size());
        for (size_t i = 0; i + 2 < primitive.positions.size(); i += 3)
            std::fill_n(target.normals.begin() + ptrdiff_t(i), 3, faceNormal(i, &target) - primitive.normals[i]);
    }
}

void addTangents(Primitive& primitive, int texCoord) {
    const size_t count = primitive.positions.size();
    if (primitive.tangents.size() != count) {
        const std::vector<glm::vec2>& uv = texCoord == 1 && !primitive.uv1.empty() ? primitive.uv1 : primitive.uv0;
        std::vector<glm::vec3> along(count, glm::vec3(0.0f)), across(count, glm::vec3(0.0f));
        for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
            const uint32_t* t = &primitive.indices[i];
            const glm::vec3 e1 = primitive.positions[t[1]] - primitive.positions[t[0]];
            const glm::vec3 e2 = primitive.positions[t[2]] - primitive.positions[t[0]];
            const glm::vec2 d1 = uv[t[1]] - uv[t[0]], d2 = uv[t[2]] - uv[t[0]];
            const float area = d1.x * d2.y - d2.x * d1.y;
            if (area == 0.0f || !std::isfinite(area)) continue;
            // Weighted by the triangle's area in space, not in texture coordinates.
            const float weight = glm::length(glm::cross(e1, e2));
            const float sign = area < 0.0f ? -1.0f : 1.0f;
            const glm::vec3 u = weight * unitOr(sign * (e1 * d2.y - e2 * d1.y), glm::vec3(0.0f));
            const glm::vec3 v = weight * unitOr(sign * (e2 * d1.x - e1 * d2.x), glm::vec3(0.0f));
            for (int k = 0; k < 3; ++k) {
                along[t[k]] += u;
                across[t[k]] += v;
            }
        }
        primitive.tangents.resize(count);
        for (size_t i = 0; i < count; ++i) {
            const glm::vec3& n = primitive.normals[i];
            const glm::vec3 t = unitOr(along[i] - n * glm::dot(n, along[i]), perpendicular(n));
            // Green of a normal map points up, v points down: cross(n, t) * w is -v.
            primitive.tangents[i] = glm::vec4(t, glm::dot(glm::cross(n, t), across[i]) > 0.0f ? -1.0f : 1.0f);
        }
    }
    for (size_t i = 0; i < count; ++i)
        if (glm::vec3(primitive.tangents[i]) == glm::vec3(0.0f))
            primitive.tangents[i] = glm::vec4(perpendicular(primitive.normals[i]), primitive.tangents[i].w);
}

void addBounds(Primitive& primitive) {
    if (primitive.positions.empty()) return;
    glm::vec3 low = primitive.positions[0], high = low;
    const auto add = [&](const glm::vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    };
    for (const glm::vec3& p : primitive.positions) add(p);
    for (const Primitive::Target& target : primitive.targets)
        for (size_t i = 0; i < target.positions.size(); ++i) add(primitive.positions[i] + target.positions[i]);
    primitive.boundsMin = low;
    primitive.boundsMax = high;
}

}  // namespace obscura::scene::gltf
