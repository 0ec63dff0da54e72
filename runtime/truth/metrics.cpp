// Errors in space, of the whole image and by region.
#include "truth/metrics.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "truth/flip.h"

namespace obscura::truth {
namespace {

constexpr float kJump = 0.02f;   // depth discontinuity, fraction of the nearer depth
constexpr int kReach = 8;        // px, extent of halo and thin regions
constexpr int kThin = 4;         // px, thin surfaces are narrower
constexpr float kBorder = 0.1f;  // of each side

struct Maps {
    Plane picture, reference, adjusted;
    float gamma = 1.0f;
    Plane ssim, flip;  // empty with Regions::scattered
};

double rmseAt(const Plane& a, const Plane& r, const Mask& mask, double gamma) {
    double square = 0.0;
    for (size_t i = 0; i < a.pixels(); ++i)
        if (mask[i]) {
            const double e = std::pow(double(a.values[i]), gamma) - r.values[i];
            square += e * e;
        }
    return square;
}

// A coarse search over the octaves, since the error can have several minima, then a golden-section search.
float bestGamma(const Plane& a, const Plane& r, const Mask& mask) {
    constexpr double kWidest = 3.0, kStep = 0.25;  // log2
    double best = 0.0, least = rmseAt(a, r, mask, 1.0);
    for (double log2 = -kWidest; log2 <= kWidest; log2 += kStep)
        if (const double error = rmseAt(a, r, mask, std::exp2(log2)); error < least) best = log2, least = error;
    constexpr double kGolden = 0.6180339887498949;
    double low = std::max(best - kStep, -kWidest), high = std::min(best + kStep, kWidest);
    double x1 = high - kGolden * (high - low), x2 = low + kGolden * (high - low);
    double e1 = rmseAt(a, r, mask, std::exp2(x1)), e2 = rmseAt(a, r, mask, std::exp2(x2));
    for (int i = 0; i < 18; ++i) {
        if (e1 <= e2) {
            high = x2, x2 = x1, e2 = e1;
            x1 = high - kGolden * (high - low);
            e1 = rmseAt(a, r, mask, std::exp2(x1));
        } else {
            low = x1, x1 = x2, e1 = e2;
            x2 = low + kGolden * (high - low);
            e2 = rmseAt(a, r, mask, std::exp2(x2));
        }
    }
    const double found = 0.5 * (low + high);
    return rmseAt(a, r, mask, std::exp2(found)) < least ? float(std::exp2(found)) : float(std::exp2(best));
}

float meanOver(const Plane& map, const Mask& mask) {
    double sum = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < map.pixels(); ++i)
        if (mask[i]) sum += map.values[i], ++count;
    return count ? float(sum / double(count)) : 0.0f;
}

float weightedMedian(const Plane& map, const Mask& mask) {
    std::vector<float> values;
    double total = 0.0;
    for (size_t i = 0; i < map.pixels(); ++i)
        if (mask[i]) values.push_back(map.values[i]), total += map.values[i];
    std::sort(values.begin(), values.end());
    double below = 0.0;
    for (const float value : values)
        if ((below += value) >= 0.5 * total) return value;
    return 0.0f;
}

Metrics judge(const Maps& maps, const Mask& mask) {
    Metrics metrics;
    metrics.pixels = size_t(std::count(mask.begin(), mask.end(), uint8_t(1)));
    if (metrics.pixels == 0) return metrics;
    metrics.raw = errors(maps.picture, maps.reference, mask);
    metrics.gamma = maps.gamma;
    metrics.adjusted = errors(maps.adjusted, maps.reference, mask);
    metrics.perceptual = !maps.ssim.values.empty();
    if (!metrics.perceptual) return metrics;
    metrics.ssim = meanOver(maps.ssim, mask);
    metrics.flipMean = meanOver(maps.flip, mask);
    metrics.flipWeightedMedian = weightedMedian(maps.flip, mask);
    return metrics;
}

Plane checked(const Plane& plane, const Mask& valid, const char* which) {
    Plane out = plane;
    for (size_t i = 0; i < plane.pixels(); ++i) {
        if (!valid[i]) {
            out.values[i] = 1.0f;
            continue;
        }
        if (!std::isfinite(plane.values[i]))
            throw scene::Error(fmt::format("the {} holds {} at pixel ({}, {})", which, plane.values[i], i % plane.width, i / plane.width));
        out.values[i] = std::clamp(plane.values[i], 0.0f, 1.0f);
    }
    return out;
}

Maps mapsOf(const Plane& visibility, const Plane& reference, const Mask& valid, bool scattered = false) {
    if (visibility.width != reference.width || visibility.height != reference.height)
        throw scene::Error(fmt::format("the picture is {} x {} pixels, its reference {} x {}", visibility.width, visibility.height,
            reference.width, reference.height));
    if (valid.size() != visibility.pixels())
        throw scene::Error(fmt::format("a mask of {} pixels for a picture of {} x {}", valid.size(), visibility.width, visibility.height));
    Maps maps;
    maps.picture = checked(visibility, valid, "picture");
    maps.reference = checked(reference, valid, "reference");
    maps.gamma = bestGamma(maps.picture, maps.reference, valid);
    maps.adjusted = maps.picture;
    for (float& value : maps.adjusted.values) value = std::pow(value, maps.gamma);
    if (scattered) return maps;
    maps.ssim = ssimMap(maps.picture, maps.reference);
    maps.flip = flip(maps.reference, maps.picture);
    return maps;
}

// ---- Regions --------------------------------------------------------------------------------------------------------

bool jumps(float nearer, float farther) { return farther > nearer * (1.0f + kJump); }

// Flood fill from the far pixel of every discontinuity, over neighbours without a discontinuity: never onto the near side.
Mask haloOf(const Plane& z, const Mask& valid) {
    const int width = int(z.width), height = int(z.height);
    std::vector<uint8_t> steps(z.pixels(), 0);
    std::vector<int> front, next;
    constexpr int kNeighbours[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    const auto forNeighbours = [&](int i, const auto& visit) {
        for (const auto& [dx, dy] : kNeighbours) {
            const int x = i % width + dx, y = i / width + dy;
            if (x >= 0 && y >= 0 && x < width && y < height) visit(y * width + x);
        }
    };
    for (int i = 0; i < width * height; ++i)
        forNeighbours(i, [&](int n) {
            if (!steps[size_t(i)] && jumps(z.values[size_t(n)], z.values[size_t(i)])) steps[size_t(i)] = 1, front.push_back(i);
        });
    for (uint8_t step = 2; step <= kReach; ++step, front.swap(next)) {
        next.clear();
        for (const int i : front)
            forNeighbours(i, [&](int n) {
                const float a = z.values[size_t(i)], b = z.values[size_t(n)];
                if (!steps[size_t(n)] && !jumps(std::min(a, b), std::max(a, b))) steps[size_t(n)] = step, next.push_back(n);
            });
    }
    Mask mask(z.pixels());
    for (size_t i = 0; i < mask.size(); ++i) mask[i] = steps[i] && valid[i];
    return mask;
}

// Minimum or maximum over the window [-before, after] along one axis, then the other.
template <class Better>
Plane extreme(const Plane& in, int before, int after, const Better& better) {
    const auto pass = [&](const Plane& source, bool horizontal) {
        Plane out = source;
        const int last = int(horizontal ? source.width : source.height) - 1;
        for (uint32_t y = 0; y < source.height; ++y)
            for (uint32_t x = 0; x < source.width; ++x)
                for (int k = -before; k <= after; ++k) {
                    const uint32_t at = uint32_t(std::clamp(int(horizontal ? x : y) + k, 0, last));
                    const float value = horizontal ? source.at(at, y) : source.at(x, at);
                    if (better(value, out.at(x, y))) out.at(x, y) = value;
                }
        return out;
    };
    return pass(pass(in, true), false);
}

// A morphological closing of the depth removes surfaces that are nearer than their surroundings and narrower than the window on either
// axis.
Mask thinOf(const Plane& z, const Mask& valid) {
    const auto greater = [](float a, float b) { return a > b; };
    const auto less = [](float a, float b) { return a < b; };
    const int before = kThin / 2, after = kThin - 1 - before;
    const Plane closed = extreme(extreme(z, before, after, greater), after, before, less);
    Plane thin(z.width, z.height);
    for (size_t i = 0; i < thin.pixels(); ++i) thin.values[i] = jumps(z.values[i], closed.values[i]) ? 1.0f : 0.0f;
    const Plane around = extreme(thin, kReach, kReach, greater);
    Mask mask(z.pixels());
    for (size_t i = 0; i < mask.size(); ++i) mask[i] = around.values[i] > 0.0f && valid[i];
    return mask;
}

}  // namespace

Errors errors(const Plane& a, const Plane& r, const Mask& mask) {
    double sum = 0.0, absolute = 0.0, square = 0.0;
    size_t close = 0;
    std::vector<float> all;
    for (size_t i = 0; i < a.pixels(); ++i) {
        if (!mask.empty() && !mask[i]) continue;
        const float e = a.values[i] - r.values[i];
        sum += e;
        absolute += std::fabs(e);
        square += double(e) * e;
        close += std::fabs(e) < 0.05f;
        all.push_back(std::fabs(e));
    }
    if (all.empty()) return {};
    const double n = double(all.size());
    const auto rank = all.begin() + std::ptrdiff_t(std::ceil(0.99 * n)) - 1;
    std::nth_element(all.begin(), rank, all.end());
    return {float(sum / n), float(absolute / n), float(double(close) / n), float(std::sqrt(square / n)), *rank};
}

Regions regionsOf(const CapturedFrame& frame, const Mask& disoccluded) {
    Regions regions;
    const Plane z = frame.visibleDepth();
    const Mask valid = frame.visibleMask();
    if (!disoccluded.empty() && disoccluded.size() != valid.size())
        throw scene::Error(fmt::format("a mask of {} pixels for a picture of {} x {}", disoccluded.size(), z.width, z.height));
    Mask border(valid.size());
    const float left = kBorder * float(z.width), top = kBorder * float(z.height);
    for (uint32_t y = 0; y < z.height; ++y)
        for (uint32_t x = 0; x < z.width; ++x) {
            const float cx = float(x) + 0.5f, cy = float(y) + 0.5f;
            const bool inside = cx > left && cx < float(z.width) - left && cy > top && cy < float(z.height) - top;
            border[size_t(y) * z.width + x] = !inside && valid[size_t(y) * z.width + x];
        }
    regions.masks[size_t(Region::whole)] = valid;
    regions.masks[size_t(Region::halo)] = haloOf(z, valid);
    regions.masks[size_t(Region::thin)] = thinOf(z, valid);
    regions.masks[size_t(Region::border)] = std::move(border);
    if (!disoccluded.empty()) {
        Mask& mask = regions.masks[size_t(Region::disoccluded)] = disoccluded;
        for (size_t i = 0; i < mask.size(); ++i) mask[i] = mask[i] && valid[i];
    }
    return regions;
}

Regions everyNth(Regions regions, uint32_t width, uint32_t n) {
    if (n <= 1) return regions;
    for (Mask& mask : regions.masks)
        for (size_t i = 0; i < mask.size(); ++i) mask[i] = mask[i] && i % width % n == 0 && i / width % n == 0;
    regions.scattered = true;
    return regions;
}

std::vector<RegionMetrics> compare(const Plane& visibility, const Plane& reference, const Regions& regions) {
    const Maps maps = mapsOf(visibility, reference, regions[Region::whole], regions.scattered);
    std::vector<RegionMetrics> all;
    for (size_t i = 0; i < kRegions; ++i) {
        if (regions.masks[i].empty()) continue;
        const Metrics metrics = judge(maps, regions.masks[i]);
        if (Region(i) == Region::whole || metrics.pixels > 0) all.push_back({Region(i), metrics});
    }
    return all;
}

Metrics compare(const Plane& visibility, const Plane& reference, const Mask& valid) {
    const Mask mask = valid.empty() ? Mask(visibility.pixels(), 1) : valid;
    return judge(mapsOf(visibility, reference, mask), mask);
}

// [Wang 2004], with windows cut at the border and renormalized.
Plane ssimMap(const Plane& a, const Plane& b) {
    constexpr int kRadius = 5;
    constexpr double kSigma = 1.5, kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
    double weights[2 * kRadius + 1];
    for (int k = -kRadius; k <= kRadius; ++k) weights[k + kRadius] = std::exp(-k * k / (2.0 * kSigma * kSigma));
    // Five moments, blurred along x, then y; double, since variances are differences of nearly equal numbers.
    using Moments = std::array<double, 5>;
    const int width = int(a.width), height = int(a.height);
    std::vector<Moments> rows(a.pixels());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            Moments sum{};
            double total = 0.0;
            for (int k = std::max(-kRadius, -x); k <= std::min(kRadius, width - 1 - x); ++k) {
                const double p = a.at(uint32_t(x + k), uint32_t(y)), q = b.at(uint32_t(x + k), uint32_t(y)), w = weights[k + kRadius];
                const double values[5] = {p, q, p * p, q * q, p * q};
                for (size_t m = 0; m < 5; ++m) sum[m] += w * values[m];
                total += w;
            }
            for (double& s : sum) s /= total;
            rows[size_t(y) * a.width + size_t(x)] = sum;
        }
    Plane out(a.width, a.height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            Moments s{};
            double total = 0.0;
            for (int k = std::max(-kRadius, -y); k <= std::min(kRadius, height - 1 - y); ++k) {
                const Moments& row = rows[size_t(y + k) * a.width + size_t(x)];
                for (size_t m = 0; m < 5; ++m) s[m] += weights[k + kRadius] * row[m];
                total += weights[k + kRadius];
            }
            for (double& v : s) v /= total;
            const double varianceA = s[2] - s[0] * s[0], varianceB = s[3] - s[1] * s[1], covariance = s[4] - s[0] * s[1];
            out.at(uint32_t(x), uint32_t(y)) = float(
                (2.0 * s[0] * s[1] + kC1) * (2.0 * covariance + kC2) / ((s[0] * s[0] + s[1] * s[1] + kC1) * (varianceA + varianceB + kC2)));
        }
    return out;
}

}  // namespace obscura::truth
