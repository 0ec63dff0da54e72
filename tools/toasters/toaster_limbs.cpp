// Legs and toast of a toaster: a skinned mesh and a mesh with a morph target.
#include "meshkit/shapes.h"
#include "meshkit/track.h"
#include "toasters/toaster_model.h"

#include <cmath>

namespace obscura::toasters {

using namespace kit;

namespace {

/// One leg about its own hip axis: a ribbed rubber sleeve and a shoe.
Mesh makeLeg() {
    Profile sleeve{{0.0f, 0.034f}, {0.021f, 0.034f}};
    constexpr int kRibs = 4;
    constexpr float kTop = 0.205f;
    for (int i = 0; i < kRibs; ++i) {
        const float low = glm::mix(0.05f, kTop - 0.02f, static_cast<float>(i) / kRibs);
        const float high = glm::mix(0.05f, kTop - 0.02f, (static_cast<float>(i) + 0.5f) / kRibs);
        sleeve.emplace_back(0.0205f, low);
        sleeve.emplace_back(0.0275f, high);
    }
    sleeve.emplace_back(0.022f, kTop);
    sleeve.emplace_back(0.0f, kTop);
    Mesh mesh = lathe(sleeve, 8);
    mesh.setMaterial(kRubber);

    struct Step {
        float scale;
        float y;
        Slot slot;
    };
    const std::vector<Step> steps{{0.0f, 0.0f, kRubber}, {0.93f, 0.0f, kRubber}, {1.0f, 0.006f, kRubber}, {1.0f, 0.014f, kPaint},
        {0.97f, 0.026f, kPaint}, {0.82f, 0.042f, kPaint}, {0.5f, 0.054f, kPaint}, {0.0f, 0.057f, kPaint}};
    std::vector<Ring> rings;
    rings.reserve(steps.size());
    for (const Step& step : steps)
        rings.push_back(superellipse(glm::vec2(0.05f, 0.074f) * step.scale, 2.4f, step.y, 14, glm::vec2(0.0f, 0.02f * step.scale)));
    mesh.append(loft(rings, [&](std::size_t ring, std::size_t) { return steps[ring].slot; }));
    return mesh;
}

}  // namespace

Geometry makeLegs() {
    Geometry geometry;
    for (float side : {1.0f, -1.0f}) geometry.mesh.append(makeLeg(), translation({side * kHipSide, 0, 0}));
    smoothNormals(geometry.mesh, 50.0f);

    constexpr float kKneeHeight = kHipHeight - kLegSegment;
    constexpr float kBlend = 0.025f;
    for (const Vertex& vertex : geometry.mesh.vertices) {
        const std::uint8_t first = vertex.position.x > 0.0f ? kHipLeft : kHipRight;
        const float y = vertex.position.y;
        const float shin = 1.0f - smoothStep(kKneeHeight - kBlend, kKneeHeight + kBlend, y);
        // The shoe is stiff: all that is wider than the sleeve moves with the ankle alone.
        const bool isShoe = y < kAnkleHeight || std::abs(std::abs(vertex.position.x) - kHipSide) > 0.03f ||
                            std::abs(vertex.position.z) > 0.03f || y < 0.058f;
        const float foot = isShoe ? 1.0f : 1.0f - smoothStep(0.058f, 0.075f, y);
        const glm::vec3 shares{(1.0f - shin) * (1.0f - foot), shin * (1.0f - foot), foot};
        SkinInfluence influence;
        // Joints without weight have index 0, as glTF requires.
        for (std::uint8_t j = 0; j < 3; ++j)
            influence.joints[j] = shares[j] > 0.0f ? static_cast<std::uint8_t>(first + j) : std::uint8_t{0};
        influence.weights = glm::vec4(shares, 0.0f);
        geometry.skin.push_back(influence);
    }
    return geometry;
}

Geometry makeToast() {
    constexpr float kHalfHeight = 0.082f;
    constexpr float kHalfThickness = 0.0135f;
    struct Step {
        float y;
        float halfWidth;
        float thickness;
    };
    // Bread that rose over its tin: straight sides, a waist, a domed top.
    const std::vector<Step> steps{{-1.0f, 0.0f, 0.0f}, {-1.0f, 0.066f, 0.75f}, {-0.93f, 0.073f, 1.0f}, {-0.45f, 0.076f, 1.0f},
        {0.0f, 0.077f, 1.0f}, {0.3f, 0.077f, 1.0f}, {0.46f, 0.084f, 1.0f}, {0.66f, 0.088f, 1.0f}, {0.84f, 0.079f, 1.0f},
        {0.96f, 0.058f, 0.95f}, {1.0f, 0.04f, 0.7f}, {1.0f, 0.0f, 0.0f}};
    // Across the slice: the crumb in front and behind, the crust round the sides.
    const std::vector<glm::vec2> section{{-0.86f, 1.0f}, {-0.3f, 1.0f}, {0.3f, 1.0f}, {0.86f, 1.0f}, {1.0f, 0.55f}, {1.0f, -0.55f},
        {0.86f, -1.0f}, {0.3f, -1.0f}, {-0.3f, -1.0f}, {-0.86f, -1.0f}, {-1.0f, -0.55f}, {-1.0f, 0.55f}};
    std::vector<Ring> rings;
    for (const Step& step : steps) {
        Ring ring;
        for (glm::vec2 p : section) ring.emplace_back(p.x * step.halfWidth, step.y * kHalfHeight, p.y * step.thickness * kHalfThickness);
        rings.push_back(ring);
    }
    Geometry geometry;
    geometry.mesh = loft(rings, [&](std::size_t ring, std::size_t column) {
        const bool isEnd = ring <= 1 || ring + 3 >= steps.size();
        const bool isSide = column % 6 >= 3;
        return isEnd || isSide ? kCrust : kBread;
    });
    smoothNormals(geometry.mesh, 50.0f);
    geometry.morphs.push_back(makeMorph(geometry.mesh, [](glm::vec3 p) {
        const float along = (p.y + kHalfHeight) / (2.0f * kHalfHeight);
        const float bend = 0.07f * along * along * along;
        return p + glm::vec3(0.0f, -0.35f * bend * along, bend);
    }));
    return geometry;
}

}  // namespace obscura::toasters
