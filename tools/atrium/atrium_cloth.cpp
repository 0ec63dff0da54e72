// Banners and awnings, with morph targets.
#include "atrium/atrium_parts.h"
#include "meshkit/shapes.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace obscura::atrium {

using namespace kit;

namespace {

constexpr float kTau = glm::two_pi<float>();

/// A sheet of columns x rows quads, shaped by a function of the unit square.
Mesh makeSheet(int columns, int rows, const std::function<glm::vec3(glm::vec2)>& shape) {
    Mesh mesh;
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column <= columns; ++column) {
            const glm::vec2 uv(
                static_cast<float>(column) / static_cast<float>(columns), static_cast<float>(row) / static_cast<float>(rows));
            mesh.addVertex(shape(uv), uv);
        }
    const auto stride = static_cast<std::uint32_t>(columns + 1);
    for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(rows); ++row)
        for (std::uint32_t column = 0; column + 1 < stride; ++column) {
            const std::uint32_t a = row * stride + column;
            mesh.addQuad(a + stride, a + stride + 1, a + 1, a, kCloth);
        }
    smoothNormals(mesh, 80.0f);
    return mesh;
}

/// Two targets a quarter wave apart; weights that run round a circle make a travelling wave.
Geometry withWaves(Mesh mesh, const std::function<glm::vec3(glm::vec3, float)>& wave) {
    Geometry geometry{std::move(mesh), {}, {}};
    for (float phase : {0.0f, 0.25f * kTau})
        geometry.morphs.push_back(makeMorph(geometry.mesh, [&](glm::vec3 p) { return p + wave(p, phase); }));
    return geometry;
}

}  // namespace

Geometry makeBanner(float width, float height) {
    Mesh mesh = makeSheet(28, 30, [&](glm::vec2 uv) {
        const float x = width * (uv.x - 0.5f);
        // Pleats gathered at the rod that open towards the hem, which dips to a point.
        const float depth = 0.022f + 0.045f * uv.y;
        const float pleats = std::sin(kTau * 4.0f * uv.x) + 0.35f * std::sin(kTau * 7.0f * uv.x + 1.0f + 2.0f * uv.y);
        const float point = 0.35f * (1.0f - std::abs(2.0f * uv.x - 1.0f));
        const float waist = 1.0f - 0.05f * std::sin(kTau * 0.5f * uv.y);
        return glm::vec3(x * waist, -uv.y * (height - 0.35f + point), depth * pleats);
    });
    return withWaves(std::move(mesh), [=](glm::vec3 p, float phase) {
        const float down = -p.y / height;
        const float swing = 0.16f * down * down * std::cos(5.0f * down - phase);
        const float flutter = 0.05f * down * std::cos(7.5f * p.x / width + 6.0f * down - phase);
        const float drift = 0.012f * down * std::sin(phase + 3.0f * down);
        return glm::vec3(drift, 0.02f * down * down * std::sin(phase), swing + flutter);
    });
}

Geometry makeBannerRod(float width) {
    Mesh mesh;
    const float half = 0.5f * width + 0.1f;
    mesh.append(cylinder(0.02f, 2.0f * half, 0.004f, 10), translation({half, 0.012f, 0}) * rotation(90, {0, 0, 1}));
    for (float side : {-1.0f, 1.0f}) {
        mesh.append(sphere(0.04f, 10, 6), translation({side * half, 0.012f, 0}));
        // The bracket back to the wall.
        mesh.append(chamferBox({-0.016f, -0.012f, -0.42f}, {0.016f, 0.032f, 0.02f}, 0.005f), translation({side * (half - 0.06f), 0, 0}));
    }
    mesh.setMaterial(kIron);
    boxMapTexcoords(mesh, 1.0f);
    smoothNormals(mesh, 50.0f);
    return {mesh, {}, {}};
}

Geometry makeAwning(float width, float span, float sag) {
    Mesh mesh = makeSheet(20, 48, [&](glm::vec2 uv) {
        const float along = 2.0f * uv.y - 1.0f;
        // Two swags between three ropes: at the sides and in the middle.
        const float swag = 1.0f - along * along;
        const float gather = 1.0f - 0.22f * swag;
        const float folds = 0.05f * std::sin(kTau * 3.0f * uv.x) * (1.0f - 0.6f * swag);
        const float edge = (2.0f * uv.x - 1.0f) * (2.0f * uv.x - 1.0f);
        return glm::vec3(width * (uv.x - 0.5f) * gather, -sag * swag + folds - 0.22f * edge * (0.35f + 0.65f * swag), 0.5f * span * along);
    });
    return withWaves(std::move(mesh), [=](glm::vec3 p, float phase) {
        const float along = 2.0f * p.z / span;
        const float free = 1.0f - along * along;
        const float heave = 0.12f * free * std::cos(4.0f * along - phase);
        const float ripple = 0.05f * free * std::cos(3.0f * p.x + 5.0f * along - phase);
        return glm::vec3(0.03f * free * std::sin(phase + 2.0f * along), heave + ripple, 0.0f);
    });
}

}  // namespace obscura::atrium
