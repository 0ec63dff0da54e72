// Reference implementation of XeGTAO on the CPU, in double precision. A direct transcription of the published formulas: no code is shared
// with the shaders, no approximate functions, no packed storage.
#pragma once

#include <glm/glm.hpp>

#include "ao/method_test.h"

namespace obscura::test {

class Published {
public:
    explicit Published(int slices = 3, int steps = 3, bool blur = true) : slices(slices), steps(steps), blurs(blur ? 1 : 0) {}
    const int slices, steps, blurs;
    static constexpr double radius = 1.0;  // metres
    static constexpr double kPi = 3.14159265358979;
    static constexpr double kRadiusMultiplier = 1.457, kFalloffRange = 0.615, kDistribution = 2.0, kMipOffset = 3.30, kFinalPower = 2.2,
                            kBeta = 1.2;

    // Obscurance of the visible part. The projection must be a symmetric perspective.
    Picture run(const Room& room, const ao::Frame& frame) {
        m_width = int(room.width), m_height = int(room.height);
        m_scale = glm::dvec2(1.0 / frame.projection[0], 1.0 / frame.projection[5]);
        m_skyDepth = frame.skyDepth;
        buildDepths(room);
        const int gx = int(frame.guard.width), gy = int(frame.guard.height), w = m_width - 2 * gx, h = m_height - 2 * gy;
        std::vector<double> visibility(size_t(w) * h);
        std::vector<glm::dvec4> edges(size_t(w) * h);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const size_t j = (size_t(y) + gy) * room.width + x + gx;
                const glm::dvec3 n(room.normals[j * 4], room.normals[j * 4 + 1], room.normals[j * 4 + 2]);
                visibility[size_t(y) * w + x] = visibilityAt(x + gx, y + gy, x, y, n);
                edges[size_t(y) * w + x] = edgesAt(x + gx, y + gy);
            }
        for (int pass = 0; pass < 2 * blurs; ++pass) visibility = blurred(visibility, edges, w, h);
        Picture result;
        for (const double v : visibility) result.push_back(float(1.0 - std::min(std::max(v, 0.0), 1.0)));
        return result;
    }

    // Index along a Hilbert curve through 64x64 pixels.
    static unsigned hilbert(unsigned x, unsigned y) {
        x %= 64, y %= 64;
        unsigned index = 0;
        for (unsigned side = 32; side > 0; side /= 2) {
            const unsigned right = (x & side) != 0, lower = (y & side) != 0;
            index += side * side * ((3 * right) ^ lower);
            if (lower) continue;
            if (right) x = 63 - x, y = 63 - y;
            std::swap(x, y);
        }
        return index;
    }

private:
    // Depth mips: the mean of four texels, weighted by their closeness to the farthest.
    void buildDepths(const Room& room) {
        const auto level0 = [&](int x, int y) {
            return double(room.depth[size_t(std::min(y, m_height - 1)) * room.width + std::min(x, m_width - 1)]);
        };
        const int w = (m_width + 15) / 16 * 16, h = (m_height + 15) / 16 * 16;
        m_depths.assign(5, {});
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) m_depths[0].push_back(level0(x, y) >= m_skyDepth ? 1e8 : level0(x, y));
        m_stride = w;
        const double reach = 0.75 * radius * kRadiusMultiplier, range = kFalloffRange * reach, from = reach * (1.0 - kFalloffRange);
        for (int level = 1; level < 5; ++level)
            for (int y = 0; y < h >> level; ++y)
                for (int x = 0; x < w >> level; ++x) {
                    double z[4], farthest = 0.0, sum = 0.0, weights = 0.0;
                    for (int i = 0; i < 4; ++i) {
                        z[i] = m_depths[level - 1][size_t(2 * y + i / 2) * (w >> (level - 1)) + 2 * x + i % 2];
                        farthest = std::max(farthest, z[i]);
                    }
                    for (const double each : z) {
                        const double weight = std::clamp((farthest - each) * (-1.0 / range) + from / range + 1.0, 0.0, 1.0);
                        sum += weight * each;
                        weights += weight;
                    }
                    m_depths[level].push_back(sum / weights);
                }
    }
    double depth(int x, int y, int level) const {
        x = std::clamp(x, 0, m_width - 1), y = std::clamp(y, 0, m_height - 1);
        return m_depths[level][size_t(y >> level) * (m_stride >> level) + (x >> level)];
    }
    glm::dvec3 position(double x, double y, double z) const {  // eye space, x and y in px
        return {(2.0 * x / m_width - 1.0) * m_scale.x * z, (2.0 * y / m_height - 1.0) * m_scale.y * z, -z};
    }

    double visibilityAt(int px, int py, int noiseX, int noiseY, glm::dvec3 n) const {
        const double own = depth(px, py, 0);
        if (own >= m_skyDepth) return 1.0;
        const double z = own * 0.99999;
        const glm::dvec3 centre = position(px + 0.5, py + 0.5, z), view = glm::normalize(-centre);
        if (glm::dot(n, view) < 0.0) n = -n;
        const double reach = radius * kRadiusMultiplier, range = kFalloffRange * reach, from = reach * (1.0 - kFalloffRange);
        const double pixelSize = z * 2.0 * std::abs(m_scale.x) / m_width, pixels = reach / pixelSize;
        const double index = hilbert(unsigned(noiseX), unsigned(noiseY)), least = 1.3 / pixels;
        const auto fraction = [](double v) { return v - std::floor(v); };
        const double noiseSlice = fraction(0.5 + index * 0.754877666), noiseSample = fraction(0.5 + index * 0.569840291);
        double visibility = std::clamp((10.0 - pixels) / 100.0, 0.0, 1.0) * 0.5;
        for (int slice = 0; slice < slices; ++slice) {
            const double phi = (slice + noiseSlice) / slices * kPi;
            const glm::dvec2 omega = glm::dvec2(std::cos(phi), std::sin(phi)) * glm::dvec2(1.0, m_scale.y < 0.0 ? -1.0 : 1.0) * pixels;
            glm::dvec3 direction(std::cos(phi), std::sin(phi), 0.0);
            direction -= glm::dot(direction, view) * view;
            const glm::dvec3 axis = glm::normalize(glm::cross(direction, view)), projected = n - axis * glm::dot(n, axis);
            const double length = glm::length(projected), cosNormal = std::clamp(glm::dot(projected, view) / length, 0.0, 1.0);
            const double gamma = (glm::dot(direction, projected) < 0.0 ? -1.0 : 1.0) * std::acos(cosNormal);
            const double low[2] = {std::cos(gamma + kPi / 2), std::cos(gamma - kPi / 2)};
            double horizon[2] = {low[0], low[1]};
            for (int step = 0; step < steps; ++step) {
                const double stepNoise = fraction(noiseSample + (slice + step * steps) * 0.6180339887498948482);
                const double s = std::pow((step + stepNoise) / steps, kDistribution) + least;
                const int level = int(std::floor(std::clamp(std::log2(s * pixels) - kMipOffset, 0.0, 4.0) + 0.5));
                const glm::dvec2 offset = glm::floor(s * omega + 0.5);
                for (int side = 0; side < 2; ++side) {
                    const glm::dvec2 at = glm::dvec2(px + 0.5, py + 0.5) + (side ? -offset : offset);
                    const glm::dvec3 delta = position(at.x, at.y, depth(int(std::floor(at.x)), int(std::floor(at.y)), level)) - centre;
                    const double distance = glm::length(delta),
                                 weight = std::clamp(distance * (-1.0 / range) + from / range + 1.0, 0.0, 1.0);
                    horizon[side] = std::max(horizon[side], glm::mix(low[side], glm::dot(delta / distance, view), weight));
                }
            }
            const double weight = glm::mix(length, 1.0, 0.05),
                         h[2] = {-std::acos(std::clamp(horizon[1], -1.0, 1.0)), std::acos(std::clamp(horizon[0], -1.0, 1.0))};
            for (const double each : h)
                visibility += weight * (cosNormal + 2.0 * each * std::sin(gamma) - std::cos(2.0 * each - gamma)) / 4.0;
        }
        return std::min(std::max(0.03, std::pow(std::max(visibility / slices, 0.0), kFinalPower)), 1.5);  // 1.5: the maximum that is stored
    }

    // Edge weights to the left, right, top and bottom, quantized to two bits.
    glm::dvec4 edgesAt(int x, int y) const {
        const double z = depth(x, y, 0);
        const glm::dvec4 steps = glm::dvec4(depth(x - 1, y, 0), depth(x + 1, y, 0), depth(x, y - 1, 0), depth(x, y + 1, 0)) - z;
        const double slopeX = (steps.y - steps.x) * 0.5, slopeY = (steps.w - steps.z) * 0.5;
        const glm::dvec4 sloped = steps + glm::dvec4(slopeX, -slopeX, slopeY, -slopeY);
        const glm::dvec4 edges = glm::clamp(1.25 - glm::min(glm::abs(steps), glm::abs(sloped)) / (z * 0.011), 0.0, 1.0);
        return glm::round(edges * 2.9) / 3.0;
    }

    static std::vector<double> blurred(const std::vector<double>& source, const std::vector<glm::dvec4>& edges, int w, int h) {
        std::vector<double> result(source.size());
        const auto index = [&](int x, int y) { return size_t(std::clamp(y, 0, h - 1)) * w + std::clamp(x, 0, w - 1); };
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const glm::dvec4 left = edges[index(x - 1, y)], right = edges[index(x + 1, y)], top = edges[index(x, y - 1)],
                                 bottom = edges[index(x, y + 1)];
                glm::dvec4 e = edges[index(x, y)] * glm::dvec4(left.y, right.x, top.w, bottom.z);
                const double edginess = std::clamp(4.0 - 2.5 - (e.x + e.y + e.z + e.w), 0.0, 1.0) / (4.0 - 2.5) * 0.5;
                e = glm::clamp(e + edginess, 0.0, 1.0);
                const double weights[9] = {0.425 * (e.x * left.z + e.z * top.x), e.z, 0.425 * (e.z * top.y + e.y * right.z), e.x, kBeta,
                    e.y, 0.425 * (e.w * bottom.x + e.x * left.w), e.w, 0.425 * (e.y * right.w + e.w * bottom.y)};
                double sum = 0.0, total = 0.0;
                for (int i = 0; i < 9; ++i) {
                    sum += weights[i] * source[index(x + i % 3 - 1, y + i / 3 - 1)];
                    total += weights[i];
                }
                result[index(x, y)] = sum / total;
            }
        return result;
    }

    int m_width = 0, m_height = 0, m_stride = 0;
    glm::dvec2 m_scale{};  // eye.xy per NDC and depth
    double m_skyDepth = 0.0;
    std::vector<std::vector<double>> m_depths;
};

inline double meanDifference(const Picture& a, const Picture& b) {
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i) sum += std::abs(double(a[i]) - b[i]);
    return sum / double(a.size());
}

}  // namespace obscura::test
