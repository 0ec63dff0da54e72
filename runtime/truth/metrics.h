// Errors of an obscurance image against its reference, in space. Every input is *visibility* (1 open, 0 blocked, linear), without guard
// band. Errors are A - R, with A the image and R the reference: a positive bias means too bright.
#pragma once

#include <array>
#include <span>

#include "truth/captured_frame.h"

namespace obscura::truth {

using Mask = std::vector<uint8_t>;  // one per pixel, 0 or 1

struct Errors {
    float bias = 0.0f;  // mean (A - R)
    float eA = 0.0f;    // mean |A - R|
    float e5 = 0.0f;    // share of pixels with |A - R| < 0.05
    float rmse = 0.0f;
    float p99 = 0.0f;  // 99th percentile of |A - R|
};

// Over valid pixels (empty mask: all), without clamping. Fast enough for every frame.
Errors errors(const Plane& visibility, const Plane& reference, const Mask& valid = {});

struct Metrics {
    size_t pixels = 0;  // evaluated; if 0, all else is 0
    Errors raw;
    float gamma = 1.0f;               // g* = argmin RMSE(A^g, R), in [1/8, 8]
    Errors adjusted;                  // of A^g*: errors that a "power" parameter cannot correct
    bool perceptual = true;           // false: SSIM and FLIP are unknown, since the pixels have no neighbours (Regions::scattered)
    float ssim = 0.0f;                // 11x11 Gaussian, sigma 1.5, C1 = 0.01^2, C2 = 0.03^2, mean over the region
    float flipMean = 0.0f;            // flip.h
    float flipWeightedMedian = 0.0f;  // the value v such that the pixels below v hold half of the summed error
};

enum class Region : uint8_t { whole, halo, thin, border, disoccluded };
inline constexpr size_t kRegions = 5;
inline constexpr std::array<const char*, kRegions> kRegionNames = {"whole", "halo", "thin", "border", "disoccluded"};

// The pixels of each region. Empty mask: unknown, no metrics.
struct Regions {
    std::array<Mask, kRegions> masks;  // subsets of the valid pixels
    bool scattered = false;            // masks have isolated pixels: no SSIM, no FLIP
    const Mask& operator[](Region region) const { return masks[size_t(region)]; }
};

// whole: all but sky. halo: up to 8 px from a depth discontinuity (more than 2 % between neighbours), on its far side. thin: up to 8 px
// around surfaces that are nearer than their surroundings by more than 2 % and narrower than 4 px. border: the outer 10 % of each side.
// disoccluded: the argument (one value per visible pixel, from reprojection), if given.
Regions regionsOf(const CapturedFrame& frame, const Mask& disoccluded = {});

// The regions restricted to every n-th pixel of each row and column, for references with RayOptions::stride n. 1 changes nothing.
Regions everyNth(Regions regions, uint32_t width, uint32_t n);

struct RegionMetrics {
    Region region;
    Metrics metrics;
};

// The whole first, even if it has no pixel; then every known region with at least one pixel. Throws scene::Error if sizes differ or a
// value is not finite. Values are clamped to [0,1]. Pixels outside `whole` count as open in the windows of SSIM and FLIP.
std::vector<RegionMetrics> compare(const Plane& visibility, const Plane& reference, const Regions& regions);

// One region: valid pixels, empty mask for all.
Metrics compare(const Plane& visibility, const Plane& reference, const Mask& valid = {});

// SSIM per pixel, for error images.
Plane ssimMap(const Plane& a, const Plane& b);

}  // namespace obscura::truth
