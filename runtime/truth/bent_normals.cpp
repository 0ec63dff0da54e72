#include "truth/bent_normals.h"

#include <algorithm>
#include <cmath>

namespace obscura::truth {

BentErrors compareBent(std::span<const glm::vec3> found, const Plane& visibility, std::span<const glm::vec3> normals,
    const BentReference& reference, const Plane& referenceVisibility, float ground, const Mask& valid) {
    const auto light = [&](const glm::vec3& n) { return ground + (1.0f - ground) * (0.5f + 0.5f * glm::normalize(n).y); };
    const auto between = [](const glm::vec3& a, const glm::vec3& b) {
        return double(glm::degrees(std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0f, 1.0f))));
    };
    double degrees = 0.0, normalDegrees = 0.0, plain = 0.0, bent = 0.0;
    BentErrors errors;
    for (size_t i = 0; i < found.size(); ++i) {
        const glm::vec3 mean(reference.mean[0].values[i], reference.mean[1].values[i], reference.mean[2].values[i]);
        if (!valid[i] || glm::length(mean) < 1e-4f || found[i] == glm::vec3(0.0f) || normals[i] == glm::vec3(0.0f)) continue;
        const float above = reference.above.values[i], expected = above + ground * (referenceVisibility.values[i] - above);
        const float open = std::clamp(visibility.values[i], 0.0f, 1.0f);
        degrees += between(found[i], mean);
        normalDegrees += between(normals[i], mean);
        plain += std::fabs(double(open * light(normals[i]) - expected));
        bent += std::fabs(double(open * light(found[i]) - expected));
        ++errors.pixels;
    }
    const double count = double(std::max<size_t>(errors.pixels, 1));
    errors.degrees = float(degrees / count);
    errors.normalDegrees = float(normalDegrees / count);
    errors.irradiance = float(plain / count);
    errors.bentIrradiance = float(bent / count);
    return errors;
}

}  // namespace obscura::truth
