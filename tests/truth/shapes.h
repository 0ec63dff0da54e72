// Test meshes for the world reference, and exact obscurance by quadrature.
#pragma once

#include <cmath>
#include <functional>

#include "truth/world_reference.h"

namespace obscura::test {

constexpr double kPi = 3.14159265358979323846;

// Owns the model and instance that its posed primitives point to.
class Shapes {
public:
    Shapes() { m_model.materials.resize(1); }

    scene::Model& model() { return m_model; }
    std::vector<scene::PosedPrimitive> posed() const {
        std::vector<scene::PosedPrimitive> out;
        for (const auto& primitive : m_primitives) {
            scene::PosedPrimitive entry;
            entry.model = &m_model;
            entry.primitive = primitive.get();
            entry.node = 0;
            entry.positions = primitive->positions;
            out.push_back(std::move(entry));
        }
        return out;
    }

    scene::Primitive& add(std::vector<glm::vec3> positions, std::vector<uint32_t> indices) {
        m_primitives.push_back(std::make_unique<scene::Primitive>());
        scene::Primitive& primitive = *m_primitives.back();
        primitive.positions = std::move(positions);
        primitive.indices = std::move(indices);
        primitive.uv0.assign(primitive.positions.size(), glm::vec2(0.0f));
        return primitive;
    }

    // c - a - b .. c + a + b, with texture coordinates from 0 to 1 along a and b.
    scene::Primitive& quad(glm::vec3 c, glm::vec3 a, glm::vec3 b) {
        scene::Primitive& primitive = add({c - a - b, c + a - b, c + a + b, c - a + b}, {0, 1, 2, 0, 2, 3});
        primitive.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        return primitive;
    }

    void sphere(glm::vec3 centre, float radius, int rings = 192) {
        std::vector<glm::vec3> positions;
        std::vector<uint32_t> indices;
        const int sides = 2 * rings;
        for (int i = 0; i <= rings; ++i)
            for (int j = 0; j <= sides; ++j) {
                const double theta = kPi * i / rings, phi = 2.0 * kPi * j / sides;
                positions.push_back(
                    centre + radius * glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)));
            }
        const auto at = [&](int i, int j) { return uint32_t(i * (sides + 1) + j); };
        for (int i = 0; i < rings; ++i)
            for (int j = 0; j < sides; ++j)
                indices.insert(indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        add(std::move(positions), std::move(indices));
    }

private:
    scene::Model m_model;
    std::vector<std::unique_ptr<scene::Primitive>> m_primitives;
};

// Obscurance of a point on a floor, normal +z: the cosine-weighted mean of rho(hit(direction)), by the midpoint rule over
// the unit disc below the directions. `hit` gives the distance, negative where the ray escapes.
inline double quadrature(
    const std::function<double(double x, double y, double z)>& hit, const std::function<double(double)>& rho, int n = 1024) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double r2 = (i + 0.5) / n, phi = 2.0 * kPi * (j + 0.5) / n, r = std::sqrt(r2);
            const double d = hit(r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0 - r2));
            if (d >= 0.0) sum += rho(d);
        }
    return sum / n / n;
}

// A wall at right angles, `distance` away in +x.
inline double wall(double distance, const std::function<double(double)>& rho, int n = 1024) {
    return quadrature([=](double x, double, double) { return x > 0.0 ? distance / x : -1.0; }, rho, n);
}

}  // namespace obscura::test
