// Errors of bent normals, and of the ambient light that is taken from them. The light is the sample's hemisphere light
// (shaders/scene/shade.glsl): radiance 1 from above the horizon, `ground` from below, so that an open surface with the normal n has the
// irradiance pi E(n), E(n) = mix(ground, 1, 1/2 + n.up / 2). The reference integrates it over the unblocked directions.
#pragma once

#include <glm/glm.hpp>

#include "truth/metrics.h"
#include "truth/reference.h"

namespace obscura::truth {

struct BentErrors {
    size_t pixels = 0;           // evaluated; if 0, all else is 0
    float degrees = 0.0f;        // mean angle to the reference's mean unblocked direction
    float normalDegrees = 0.0f;  // that of the normals
    // Mean absolute errors of irradiance, over pi times the light's radiance from above.
    float irradiance = 0.0f;      // visibility x E(normal)
    float bentIrradiance = 0.0f;  // visibility x E(bent normal)
};

// Over the valid pixels (one per visible pixel) that the reference has rays for. found, normals: world space, any length; 0 is left out.
BentErrors compareBent(std::span<const glm::vec3> found, const Plane& visibility, std::span<const glm::vec3> normals,
    const BentReference& reference, const Plane& referenceVisibility, float ground, const Mask& valid);

}  // namespace obscura::truth
