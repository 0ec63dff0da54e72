// LDR-FLIP [Andersson 2020]: a colour pipeline (contrast-sensitivity filters, Hunt-adjusted CIELAB, HyAB distance) and a feature pipeline
// (edges and points), combined as colour^(1 - feature). Equation numbers are the paper's.
#include "truth/flip.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <glm/glm.hpp>

namespace obscura::truth {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Colors {
    uint32_t width, height;
    std::vector<glm::vec3> values;
};

// Linear sRGB primaries and D65, as exact ratios of the standard's chromaticities; glm takes columns.
const glm::dmat3 kXyzFromRgb =
    glm::transpose(glm::dmat3(10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0, 2613072.0 / 12288897.0,
        8788810.0 / 12288897.0, 887015.0 / 12288897.0, 1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0));
const glm::dmat3 kRgbFromXyz = glm::inverse(kXyzFromRgb);
const glm::dvec3 kWhite = kXyzFromRgb * glm::dvec3(1.0);

// L*, a*, b* without the cube root: the opponent space of the contrast-sensitivity filters.
glm::vec3 opponent(const glm::vec3& rgb) {
    const glm::dvec3 t = kXyzFromRgb * glm::dvec3(rgb) / kWhite;
    return {116.0 * t.y - 16.0, 500.0 * (t.x - t.y), 200.0 * (t.y - t.z)};
}

glm::vec3 rgbOfOpponent(const glm::vec3& c) {
    const double y = (c.x + 16.0) / 116.0;
    return glm::vec3(kRgbFromXyz * (glm::dvec3(y + c.y / 500.0, y, y - c.z / 200.0) * kWhite));
}

// CIELAB, its chroma scaled by lightness [Hunt effect].
glm::vec3 huntLab(const glm::vec3& rgb) {
    constexpr double kDelta = 6.0 / 29.0;
    glm::dvec3 t = kXyzFromRgb * glm::dvec3(rgb) / kWhite;
    for (int i = 0; i < 3; ++i) t[i] = t[i] > kDelta * kDelta * kDelta ? std::cbrt(t[i]) : t[i] / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
    const double lightness = 116.0 * t.y - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (t.x - t.y), 0.01 * lightness * 200.0 * (t.y - t.z)};
}

float hyab(const glm::vec3& a, const glm::vec3& b) {
    const glm::vec3 d = a - b;
    return std::fabs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

using Kernel = std::vector<float>;  // 2r + 1 taps

// Separable convolution; pixels of the border are repeated outside.
Plane filter(const Plane& in, const Kernel& alongX, const Kernel& alongY) {
    const auto pass = [](const Plane& source, const Kernel& kernel, bool horizontal) {
        Plane out(source.width, source.height);
        const int r = int(kernel.size() / 2), last = int(horizontal ? source.width : source.height) - 1;
        for (uint32_t y = 0; y < source.height; ++y)
            for (uint32_t x = 0; x < source.width; ++x) {
                float sum = 0.0f;
                for (int k = -r; k <= r; ++k) {
                    const uint32_t at = uint32_t(std::clamp(int(horizontal ? x : y) + k, 0, last));
                    sum += kernel[size_t(k + r)] * (horizontal ? source.at(at, y) : source.at(x, at));
                }
                out.at(x, y) = sum;
            }
        return out;
    };
    return pass(pass(in, alongX, true), alongY, false);
}

// The contrast sensitivity of one channel as a sum of Gaussians a sqrt(pi/b) exp(-pi^2 x^2 / b) of x degrees [eq. 2, table 1].
// Each is separable; together they sum to 1.
struct Sensitivity {
    double a[2], b[2];
};
constexpr Sensitivity kSensitivity[3] = {{{1.0, 0.0}, {0.0047, 1e-5}}, {{1.0, 0.0}, {0.0053, 1e-5}}, {{34.1, 13.5}, {0.04, 0.025}}};
constexpr double kWidest = 0.04;

Plane contrastFiltered(const Plane& in, const Sensitivity& s, float pixelsPerDegree) {
    const int r = int(std::ceil(3.0 * std::sqrt(kWidest / (2.0 * kPi * kPi)) * pixelsPerDegree));
    Kernel kernels[2];
    double weights[2], total = 0.0;
    for (int g = 0; g < 2; ++g) {
        double sum = 0.0;
        for (int k = -r; k <= r; ++k) {
            const double x = k / double(pixelsPerDegree);
            kernels[g].push_back(float(std::exp(-kPi * kPi * x * x / s.b[g])));
            sum += kernels[g].back();
        }
        for (float& tap : kernels[g]) tap = float(tap / sum);
        weights[g] = s.a[g] * std::sqrt(kPi / s.b[g]) * sum * sum;
        total += weights[g];
    }
    Plane out(in.width, in.height);
    for (int g = 0; g < 2; ++g) {
        if (weights[g] == 0.0) continue;
        const Plane part = filter(in, kernels[g], kernels[g]);
        for (size_t i = 0; i < out.pixels(); ++i) out.values[i] += float(weights[g] / total) * part.values[i];
    }
    return out;
}

// The smoothed derivative of order 1 (edges) or 2 (points), positive and negative weights normalized to 1 and -1 in 2D; its
// length over both axes [eq. 7 and 8].
Plane features(const Plane& lightness, int order, float pixelsPerDegree) {
    const double sd = 0.5 * 0.082 * pixelsPerDegree;
    const int r = int(std::ceil(3.0 * sd));
    Kernel smooth, derivative;
    double sum = 0.0, positive = 0.0, negative = 0.0;
    for (int k = -r; k <= r; ++k) {
        const double g = std::exp(-k * k / (2.0 * sd * sd));
        const double d = order == 1 ? -k * g : (k * k / (sd * sd) - 1.0) * g;
        smooth.push_back(float(g));
        derivative.push_back(float(d));
        sum += g;
        (d > 0.0 ? positive : negative) += std::fabs(d);
    }
    for (float& tap : smooth) tap = float(tap / sum);
    for (float& tap : derivative) tap = float(tap > 0.0f ? tap / positive : tap / negative);
    Plane x = filter(lightness, derivative, smooth);
    const Plane y = filter(lightness, smooth, derivative);
    for (size_t i = 0; i < x.pixels(); ++i) x.values[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
    return x;
}

struct Perceived {
    std::array<Plane, 3> opponent;
    std::vector<glm::vec3> lab;
    Plane edges, points;
};

Perceived perceive(const std::array<Plane, 3>& rgb, float pixelsPerDegree) {
    Perceived out;
    const uint32_t width = rgb[0].width, height = rgb[0].height;
    for (Plane& plane : out.opponent) plane = Plane(width, height);
    Plane lightness(width, height);
    for (size_t i = 0; i < rgb[0].pixels(); ++i) {
        const glm::vec3 c = opponent(glm::clamp(glm::vec3(rgb[0].values[i], rgb[1].values[i], rgb[2].values[i]), 0.0f, 1.0f));
        for (int k = 0; k < 3; ++k) out.opponent[size_t(k)].values[i] = c[k];
        lightness.values[i] = (c.x + 16.0f) / 116.0f;
    }
    std::array<Plane, 3> filtered;
    for (size_t k = 0; k < 3; ++k) filtered[k] = contrastFiltered(out.opponent[k], kSensitivity[k], pixelsPerDegree);
    out.lab.resize(rgb[0].pixels());
    for (size_t i = 0; i < out.lab.size(); ++i)
        out.lab[i] = huntLab(glm::clamp(rgbOfOpponent({filtered[0].values[i], filtered[1].values[i], filtered[2].values[i]}), 0.0f, 1.0f));
    out.edges = features(lightness, 1, pixelsPerDegree);
    out.points = features(lightness, 2, pixelsPerDegree);
    return out;
}

}  // namespace

Plane flip(const std::array<Plane, 3>& reference, const std::array<Plane, 3>& test, float pixelsPerDegree) {
    assert(reference[0].pixels() == test[0].pixels() && reference[0].width == test[0].width);
    constexpr float kColorExponent = 0.7f, kFeatureExponent = 0.5f, kKnee = 0.4f, kKneeValue = 0.95f;
    const Perceived a = perceive(reference, pixelsPerDegree), b = perceive(test, pixelsPerDegree);
    // The largest possible distance, between green and blue [eq. 5].
    const float largest = std::pow(hyab(huntLab({0.0f, 1.0f, 0.0f}), huntLab({0.0f, 0.0f, 1.0f})), kColorExponent);
    const float knee = kKnee * largest;
    Plane out(reference[0].width, reference[0].height);
    for (size_t i = 0; i < out.pixels(); ++i) {
        const float distance = std::pow(hyab(a.lab[i], b.lab[i]), kColorExponent);
        const float color =
            distance < knee ? kKneeValue / knee * distance : kKneeValue + (distance - knee) / (largest - knee) * (1.0f - kKneeValue);
        const float feature =
            std::max(std::fabs(a.edges.values[i] - b.edges.values[i]), std::fabs(a.points.values[i] - b.points.values[i]));
        out.values[i] = std::pow(color, 1.0f - std::pow(std::min(feature / std::sqrt(2.0f), 1.0f), kFeatureExponent));
    }
    return out;
}

Plane flip(const Plane& reference, const Plane& test, float pixelsPerDegree) {
    return flip({reference, reference, reference}, {test, test, test}, pixelsPerDegree);
}

}  // namespace obscura::truth
