// Analytic half-spaces, spheres, boxes and upright cylinders: rendered as a frame with depth layers, and ray-traced as a reference.
// Eye space, metres.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <glm/glm.hpp>

#include "ao/method_test.h"

namespace obscura::test {

struct Hit {
    float front = std::numeric_limits<float>::infinity(), back = front;  // along the ray
    glm::vec3 normal{0, 0, 1};
    bool operator<(const Hit& other) const { return front < other.front; }
};

struct Solid {
    enum class Kind { plane, sphere, box, cylinder } kind;
    glm::vec3 at, size;  // plane: a point and the normal outwards; sphere, cylinder: size.x the radius; box: half its sides

    bool meets(const glm::vec3& o, const glm::vec3& d, Hit& hit) const {
        constexpr float kEndless = std::numeric_limits<float>::infinity();
        hit = {};
        if (kind == Kind::plane) {
            const glm::vec3 n = glm::normalize(size);
            const float speed = glm::dot(d, n);
            hit = {glm::dot(at - o, n) / speed, kEndless, n};
            return speed < 0.0f && hit.front > 0.0f;
        }
        float in = 0.0f, out = kEndless;
        if (kind == Kind::box) {
            in = -kEndless;
            for (int axis = 0; axis < 3; ++axis) {
                const float a = (at[axis] - size[axis] - o[axis]) / d[axis], b = (at[axis] + size[axis] - o[axis]) / d[axis];
                if (std::min(a, b) > in) {
                    in = std::min(a, b);
                    hit.normal = glm::vec3(0);
                    hit.normal[axis] = d[axis] > 0.0f ? -1.0f : 1.0f;
                }
                out = std::min(out, std::max(a, b));
            }
        } else {
            glm::vec3 to = o - at, along = d;
            if (kind == Kind::cylinder) to.y = along.y = 0.0f;
            const float a = glm::dot(along, along), b = glm::dot(to, along), c = glm::dot(to, to) - size.x * size.x, root = b * b - a * c;
            if (root <= 0.0f) return false;
            in = (-b - std::sqrt(root)) / a;
            out = (-b + std::sqrt(root)) / a;
            hit.normal = glm::normalize(to + in * along);
        }
        hit.front = in;
        hit.back = out;
        return in < out && in > 0.0f;
    }
};

// The camera of Room, turned by `tilt`: 60 degrees over the visible height. `half`: the second layer has half the size.
inline Room frameOf(const std::vector<Solid>& solids, uint32_t width, uint32_t height, uint32_t guard, bool half = false) {
    Room room;
    room.width = width;
    room.height = height;
    room.guard = guard;
    room.build();
    room.bits.clear();
    room.thickness.assign(room.depth.size(), 65504.0f);
    room.second.assign(half ? size_t((width + 1) / 2) * ((height + 1) / 2) * 2 : room.depth.size() * 2, 0.0f);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const auto [right, up] = rayAt(room, float(x) + 0.5f, float(y) + 0.5f);
            const glm::vec3 d(right, up, -1.0f);
            std::vector<Hit> hits;
            Hit hit;
            for (const Solid& solid : solids)
                if (solid.meets(glm::vec3(0), d, hit)) hits.push_back(hit);
            std::sort(hits.begin(), hits.end());
            const size_t i = size_t(y) * width + x;
            room.depth[i] = hits.empty() || hits[0].front > 200.0f ? 1e4f : hits[0].front;
            if (hits.empty()) continue;
            for (int axis = 0; axis < 3; ++axis) room.normals[i * 4 + size_t(axis)] = hits[0].normal[axis];
            const auto lengthOf = [](const Hit& h) { return std::min(h.back - h.front, 65504.0f); };
            room.thickness[i] = lengthOf(hits[0]);
            const auto next = std::find_if(hits.begin(), hits.end(), [&](const Hit& h) { return h.front >= hits[0].back * 0.9999f; });
            if (next == hits.end() || (half && ((x | y) & 1))) continue;
            const size_t j = half ? size_t(y / 2) * ((width + 1) / 2) + x / 2 : i;
            room.second[2 * j] = next->front;
            room.second[2 * j + 1] = lengthOf(*next);
        }
    return room;
}

// The same without depth layers, 160 x 80 px visible.
inline Room depthFrameOf(const std::vector<Solid>& solids) {
    Room room = frameOf(solids, 200, 120, 20);
    room.thickness.clear();
    room.second.clear();
    return room;
}

// A floor 1.5 m below the camera and a wall that faces it, 5 m away.
inline std::vector<Solid> floorAndWall() {
    return {{Solid::Kind::plane, {0, -1.5f, 0}, {0, 1, 0}}, {Solid::Kind::plane, {0, 0, -5}, {0, 0, 1}}};
}

// Worlds of one convex solid, which are open everywhere: planes alone, or also a sphere and a box.
inline std::vector<std::vector<Solid>> planeWorlds() {
    using Kind = Solid::Kind;
    return {{{Kind::plane, {0, -1.5f, 0}, {0, 1, 0}}}, {{Kind::plane, {0, -1.5f, 0}, {0.5f, 1, 0.05f}}},
        {{Kind::plane, {0, 0, -6}, {0.5f, 0.3f, 1}}}};
}
inline std::vector<std::vector<Solid>> convexWorlds() {
    std::vector<std::vector<Solid>> worlds = planeWorlds();
    worlds.push_back({{Solid::Kind::sphere, {0.3f, 0.2f, -4}, {1.2f, 0, 0}}});
    worlds.push_back({{Solid::Kind::box, {0.4f, -0.7f, -4}, {0.8f, 0.5f, 0.6f}}});
    return worlds;
}

// Obscurance at a point, by cosine-weighted rays.
inline double worldObscurance(const std::vector<Solid>& solids, const glm::vec3& p, const glm::vec3& n, const ao::Falloff& rho, int rays) {
    const glm::vec3 t = glm::normalize(glm::cross(n, std::abs(n.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0))), b = glm::cross(n, t);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform;
    double sum = 0.0;
    for (int i = 0; i < rays; ++i) {
        const float u = (float(i) + uniform(random)) / float(rays), phi = 6.2831853f * std::fmod(float(i) * 0.61803399f, 1.0f),
                    r = std::sqrt(u);
        const glm::vec3 d = r * std::cos(phi) * t + r * std::sin(phi) * b + std::sqrt(1.0f - u) * n;
        float nearest = std::numeric_limits<float>::infinity();
        Hit hit;
        for (const Solid& solid : solids)
            if (solid.meets(p + 1e-4f * n, d, hit)) nearest = std::min(nearest, hit.front);
        if (nearest < 1e30f) sum += ao::evaluate(rho, nearest);
    }
    return sum / rays;
}

inline glm::vec3 pointAt(const Room& room, uint32_t x, uint32_t y) {  // guard band included
    const auto [right, up] = rayAt(room, float(x) + 0.5f, float(y) + 0.5f);
    return room.depth[size_t(y) * room.width + x] * glm::vec3(right, up, -1.0f);
}

}  // namespace obscura::test
