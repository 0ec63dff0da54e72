// How far a picture of obscurance is from its reference, in space. Every input is *visibility* (1 open, 0 blocked, linear),
// without guard band; errors are A - R with A the picture and R the reference, so a positive bias means too bright.
#pragma once

#include <array>
#include <span>

#include "truth/captured_frame.h"

namespace obscura::truth {

using Mask = std::vector<uint8_t>;  // one a pixel, 0 or 1

struct Errors {
    float bias = 0.0f;   // mean (A - R)
    float eA = 0.0f;     // mean |A - R|
    float e5 = 0.0f;     // share of pixels with |A - R| < 0.05
    float rmse = 0.0f;
    float p99 = 0.0f;    // 99th percentile of |A - R|
};

// Over valid pixels (mask empty: all); values are taken as they are. Cheap enough for every frame.
Errors errors(const Plane& visibility, const Plane& reference, const Mask& valid = {});

struct Metrics {
    size_t pixels = 0;   // judged; with none, everything else is 0
    Errors raw;
    float gamma = 1.0f;  // g* = argmin RMSE(A^g, R), in [1/8, 8]
    Errors adjusted;     // of A^g*: what remains when only a "power" slider was missing
    bool perceptual = true;  // false: the pixels were judged apart from each other, and what follows, which is of neighbourhoods, is not known
    float ssim = 0.0f;   // 11x11 Gaussian, sigma 1.5, C1 = 0.01^2, C2 = 0.03^2, mean over the region
    float flipMean = 0.0f;            // flip.h
    float flipWeightedMedian = 0.0f;  // the value v such that the pixels below v hold half of the summed error
};

enum class Region : uint8_t { whole, halo, thin, border, disoccluded };
inline constexpr size_t kRegions = 5;
inline constexpr std::array<const char*, kRegions> kRegionNames = {"whole", "halo", "thin", "border", "disoccluded"};

// Where each region lies. An empty mask: not known, its metrics are left out.
struct Regions {
    std::array<Mask, kRegions> masks;  // subsets of the valid pixels
    bool scattered = false;            // masks hold pixels apart from each other: no SSIM, no FLIP
    const Mask& operator[](Region region) const { return masks[size_t(region)]; }
};

// whole: not sky. halo: up to 8 px from a jump of depth between neighbours of more than 2 %, on its far side. thin: up to
// 8 px around what is nearer than its surroundings by more than 2 % and narrower than 4 px. border: the outer 10 % of each
// side. disoccluded: `disoccluded` (one a visible pixel, from whoever reprojects), where given.
Regions regionsOf(const CapturedFrame& frame, const Mask& disoccluded = {});

// The same regions at every n-th pixel of each row and column alone, where a reference of RayOptions::stride n is known. 1 changes nothing.
Regions everyNth(Regions regions, uint32_t width, uint32_t n);

struct RegionMetrics {
    Region region;
    Metrics metrics;
};

// Every known region with at least one pixel, whole first. Throws scene::Error when sizes differ or a value is not finite
// (says where). Values outside [0,1] are clamped. Pixels outside `whole` count as open in SSIM and FLIP windows.
std::vector<RegionMetrics> compare(const Plane& visibility, const Plane& reference, const Regions& regions);

// One region only: valid pixels as a mask, empty for all.
Metrics compare(const Plane& visibility, const Plane& reference, const Mask& valid = {});

// Maps behind the means, for error pictures.
Plane ssimMap(const Plane& a, const Plane& b);

}  // namespace obscura::truth
