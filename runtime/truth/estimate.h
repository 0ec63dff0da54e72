// The running estimate of a receiver: sums per sequence, mean and standard error. Private to truth.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "truth/rays.h"
#include "truth/reference.h"

namespace obscura::truth {

static_assert(kBatch == shared::kSequences);

using Sums = std::array<float, kBatch>;  // one per sequence

// Mean over all rays, and its standard error from the scatter of the sequences' means. Each mean is an unbiased estimate, so the scatter
// includes the gain from stratification.
struct Estimate {
    float mean = 0.0f;
    float error = 0.0f;
};
inline Estimate estimate(const Sums& sums, uint32_t points) {
    double mean = 0.0, square = 0.0;
    for (const float sum : sums) mean += sum;
    mean /= kBatch;
    for (const float sum : sums) square += (sum - mean) * (sum - mean);
    const double scale = 1.0 / double(points);
    return {float(mean * scale), float(std::sqrt(square / (kBatch - 1.0) / kBatch) * scale)};
}

// Points per sequence: minimum, maximum, and the step between two tests of the error.
struct Schedule {
    uint32_t first, last, step = 4;
    float target;
    explicit Schedule(const RayOptions& options)
        : first(std::max((std::min(options.minRays, options.maxRays) + kBatch - 1) / kBatch, 2u)),
          last(std::max((options.maxRays + kBatch - 1) / kBatch, first)),
          target(options.targetError) {
        if (target <= 0.0f) first = last;
    }
};

// Output planes for `falloffs`, all zero.
inline Reference emptyReference(uint32_t width, uint32_t height, std::span<const RayFalloff> falloffs) {
    Reference reference;
    for (const RayFalloff& falloff : falloffs) reference.channels.push_back({falloff.name, Plane(width, height), Plane(width, height), {}});
    reference.rays = Plane(width, height);
    return reference;
}

}  // namespace obscura::truth
