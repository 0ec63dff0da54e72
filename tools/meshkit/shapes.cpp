#include "meshkit/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace obscura::kit {

namespace {

constexpr float kTau = glm::two_pi<float>();

/// The outline moved inwards by `distance`, with mitred corners.
Profile inset(std::span<const glm::vec2> outline, float distance) {
    const auto inward = [](glm::vec2 a, glm::vec2 b) {
        const glm::vec2 along = glm::normalize(b - a);
        return glm::vec2(-along.y, along.x);
    };
    Profile result;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const glm::vec2 before = outline[(i + outline.size() - 1) % outline.size()];
        const glm::vec2 after = outline[(i + 1) % outline.size()];
        const glm::vec2 n0 = inward(before, outline[i]);
        const glm::vec2 n1 = inward(outline[i], after);
        result.push_back(outline[i] + (n0 + n1) * (distance / (1.0f + glm::dot(n0, n1))));
    }
    return result;
}

Ring ringAt(const Profile& outline, float z) {
    Ring ring;
    for (glm::vec2 p : outline) ring.emplace_back(p, z);
    return ring;
}

Ring poleOf(const Ring& ring) {
    glm::vec3 sum(0.0f);
    for (glm::vec3 p : ring) sum += p;
    return Ring(ring.size(), sum / static_cast<float>(ring.size()));
}

}  // namespace

Mesh loft(std::span<const Ring> rings, const StripMaterial& material) {
    Mesh mesh;
    const std::size_t columns = rings.front().size();
    for (std::size_t r = 0; r < rings.size(); ++r)
        for (std::size_t c = 0; c <= columns; ++c)
            mesh.addVertex(rings[r][c % columns],
                {static_cast<float>(c) / static_cast<float>(columns), 1.0f - static_cast<float>(r) / static_cast<float>(rings.size() - 1)});
    const auto index = [&](std::size_t r, std::size_t c) { return static_cast<std::uint32_t>(r * (columns + 1) + c); };
    for (std::size_t r = 0; r + 1 < rings.size(); ++r)
        for (std::size_t c = 0; c < columns; ++c)
            mesh.addQuad(index(r, c), index(r, c + 1), index(r + 1, c + 1), index(r + 1, c), material ? material(r, c) : 0);
    return mesh;
}

Ring superellipse(glm::vec2 half, float exponent, float y, int segments, glm::vec2 centre) {
    const auto power = [&](float v) { return std::copysign(std::pow(std::abs(v), 2.0f / exponent), v); };
    Ring ring;
    for (int i = 0; i < segments; ++i) {
        const float angle = kTau * static_cast<float>(i) / static_cast<float>(segments);
        ring.emplace_back(centre.x + half.x * power(std::sin(angle)), y, centre.y + half.y * power(std::cos(angle)));
    }
    return ring;
}

Mesh lathe(const Profile& profile, int segments, const StripMaterial& material) {
    std::vector<Ring> rings;
    for (glm::vec2 p : profile) rings.push_back(superellipse(glm::vec2(p.x), 2.0f, p.y, segments));
    return loft(rings, material);
}

Profile fillet(const Profile& corners, float radius, int segments) {
    Profile result{corners.front()};
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        const glm::vec2 toBefore = corners[i - 1] - corners[i];
        const glm::vec2 toAfter = corners[i + 1] - corners[i];
        const float reach = std::min({radius, 0.45f * glm::length(toBefore), 0.45f * glm::length(toAfter)});
        const glm::vec2 from = corners[i] + glm::normalize(toBefore) * reach;
        const glm::vec2 to = corners[i] + glm::normalize(toAfter) * reach;
        // A quadratic curve through the corner's control point is as good as an arc at this size.
        for (int s = 0; s <= segments; ++s) {
            const float t = static_cast<float>(s) / static_cast<float>(segments);
            result.push_back(glm::mix(glm::mix(from, corners[i], t), glm::mix(corners[i], to, t), t));
        }
    }
    result.push_back(corners.back());
    return result;
}

Mesh sphere(float radius, int segments, int rings) {
    Profile profile;
    for (int i = 0; i <= rings; ++i) {
        const float angle = glm::pi<float>() * static_cast<float>(i) / static_cast<float>(rings);
        const bool pole = i == 0 || i == rings;
        profile.emplace_back(pole ? 0.0f : radius * std::sin(angle), -radius * std::cos(angle));
    }
    return lathe(profile, segments);
}

Mesh torus(float major, float minor, int segments, int sides) { return link(0.0f, major, minor, segments, sides); }

Mesh link(float halfLength, float major, float minor, int segments, int sides) {
    std::vector<Ring> rings;
    for (int side = 0; side <= sides; ++side) {
        const float turn = kTau * static_cast<float>(side % sides) / static_cast<float>(sides);
        const float radius = major + minor * std::sin(turn);
        Ring ring = superellipse(glm::vec2(radius), 2.0f, -minor * std::cos(turn), segments);
        for (int i = 0; i < segments; ++i) {
            const float angle = kTau * static_cast<float>(i) / static_cast<float>(segments);
            ring[i].z += std::copysign(halfLength, std::cos(angle));
        }
        rings.push_back(ring);
    }
    return loft(rings);
}

Mesh cylinder(float radius, float height, float bevel, int segments) {
    return lathe(
        {{0.0f, 0.0f}, {radius - bevel, 0.0f}, {radius, bevel}, {radius, height - bevel}, {radius - bevel, height}, {0.0f, height}},
        segments);
}

Mesh roundedBox(glm::vec3 half, float radius, int segments) {
    // A cube's grid has lines only where the rounding needs them; each point is pushed from the
    // inner box outwards by the radius.
    const auto lines = [&](float extent) {
        std::vector<float> result;
        for (int i = 0; i <= segments; ++i) {
            const float angle = glm::quarter_pi<float>() * (1.0f - static_cast<float>(i) / static_cast<float>(segments));
            result.push_back(-extent + radius * (1.0f - std::tan(angle)));
        }
        for (int i = segments; i >= 0; --i) result.push_back(-result[i]);
        return result;
    };
    const glm::vec3 core = half - glm::vec3(radius);
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (float sign : {-1.0f, 1.0f}) {
            const int u = (axis + 1) % 3;
            const int v = (axis + 2) % 3;
            const std::vector<float> us = lines(half[u]);
            const std::vector<float> vs = lines(half[v]);
            const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
            for (float a : us)
                for (float b : vs) {
                    glm::vec3 p;
                    p[axis] = sign * half[axis];
                    p[u] = a;
                    p[v] = b;
                    const glm::vec3 inner = glm::clamp(p, -core, core);
                    mesh.addVertex(inner + glm::normalize(p - inner) * radius);
                }
            const auto stride = static_cast<std::uint32_t>(vs.size());
            for (std::uint32_t i = 0; i + 1 < us.size(); ++i)
                for (std::uint32_t j = 0; j + 1 < vs.size(); ++j) {
                    const std::uint32_t a = first + i * stride + j;
                    if (sign > 0.0f) mesh.addQuad(a, a + stride, a + stride + 1, a + 1);
                    else mesh.addQuad(a, a + 1, a + stride + 1, a + stride);
                }
        }
    return mesh;
}

Mesh chamferBox(glm::vec3 low, glm::vec3 high, float bevel) {
    const std::array<glm::vec2, 4> outline{glm::vec2{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}};
    // The upright edges are cut first, so that no edge of the box stays sharp.
    Profile cut;
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::vec2 p = outline[i];
        cut.push_back(p + glm::normalize(outline[(i + 3) % 4] - p) * bevel);
        cut.push_back(p + glm::normalize(outline[(i + 1) % 4] - p) * bevel);
    }
    return bevelledPrism(cut, low.z, high.z, bevel);
}

Mesh bevelledPrism(std::span<const glm::vec2> outline, float z0, float z1, float bevel) {
    const Profile full(outline.begin(), outline.end());
    const Profile small = inset(outline, bevel);
    const Ring bottom = ringAt(small, z0);
    const Ring top = ringAt(small, z1);
    const std::array<Ring, 6> rings{poleOf(bottom), bottom, ringAt(full, z0 + bevel), ringAt(full, z1 - bevel), top, poleOf(top)};
    return loft(rings);
}

Mesh tube(std::span<const glm::vec3> path, float radius, int sides) {
    std::vector<Ring> rings{Ring(sides, path.front())};
    glm::vec3 across(0.0f);
    for (std::size_t i = 0; i < path.size(); ++i) {
        const glm::vec3 along = glm::normalize(path[std::min(i + 1, path.size() - 1)] - path[i == 0 ? 0 : i - 1]);
        // Carrying the last direction over keeps the tube from twisting.
        const glm::vec3 hint = i > 0 ? across : (std::abs(along.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0));
        across = glm::normalize(hint - along * glm::dot(hint, along));
        const glm::vec3 other = glm::cross(along, across);
        Ring ring;
        for (int s = 0; s < sides; ++s) {
            const float angle = kTau * static_cast<float>(s) / static_cast<float>(sides);
            ring.push_back(path[i] + radius * (std::cos(angle) * across + std::sin(angle) * other));
        }
        rings.push_back(ring);
    }
    rings.push_back(Ring(sides, path.back()));
    return loft(rings);
}

glm::mat4 translation(glm::vec3 offset) { return glm::translate(glm::mat4(1.0f), offset); }

glm::mat4 rotation(float degrees, glm::vec3 axis) { return glm::rotate(glm::mat4(1.0f), glm::radians(degrees), axis); }

glm::mat4 scaling(glm::vec3 factor) { return glm::scale(glm::mat4(1.0f), factor); }

glm::mat4 aimY(glm::vec3 direction) {
    const glm::vec3 y = glm::normalize(direction);
    const glm::vec3 hint = std::abs(y.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    const glm::vec3 z = glm::normalize(glm::cross(hint, y));
    return glm::mat4(glm::mat3(glm::cross(y, z), y, z));
}

}  // namespace obscura::kit
