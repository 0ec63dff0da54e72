// Inputs and results of both references. A reference is cosine-weighted ray casting: obscurance = mean of rho(distance of the first hit)
// over rays distributed as cos(angle to the normal) / pi; rays without a hit count as 0. 0 open, 1 blocked.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "obscura/ao.h"
#include "truth/picture.h"

namespace obscura::truth {

// A falloff as a function. `rho` maps metres to [0,1], is pure, and is called from several threads.
struct RayFalloff {
    std::string name;  // "quadratic:2": name of channels; part of the cache key, with samples of rho
    std::function<float(float)> rho;
    float reach = 1.0f;  // metres; rays end here. Infinity is allowed in the world reference only
    bool hard = false;   // rho is 1 up to reach: any hit suffices, its distance is not needed
};
// The library's falloff. An exponential is followed to 1/65536, not only to the 1/256 at which methods stop.
RayFalloff rayFalloff(const ao::Falloff& falloff);
// From "quadratic:2"; throws scene::Error, which lists the falloffs, if malformed.
RayFalloff rayFalloff(const std::string& text);

// Rays come in batches of 16, one for each of 16 independently scrambled Sobol sequences; the scatter of the sequences' means gives the
// standard error. A pixel stops when the standard error of every falloff is at most `targetError`, or at maxRays. minRays == maxRays
// requests a fixed count.
struct RayOptions {
    uint32_t minRays = 128;  // rounded up to whole batches, at least two
    uint32_t maxRays = 4096;
    float targetError = 0.005f;  // of obscurance; 0: always maxRays
    uint32_t seed = 1;
    // Only every stride-th visible pixel in x and y; the others have 0 rays and obscurance 0. For tests and previews.
    uint32_t stride = 1;
    // Gets the fraction done, 0 to 1, increasing, on the calling thread. Return false to cancel: trace() throws scene::Error.
    std::function<bool(float)> progress;
};

inline constexpr uint32_t kBatch = 16;

// Of unblocked light, from the same rays: with V = 1 - rho(distance of the first hit), means over the rays. World space, y up.
struct BentReference {
    Plane mean[3];  // x, y, z of V times the ray; not normalised. With an open hemisphere 2/3 of the normal
    Plane above;    // V of the rays that go up, 0 for others
    explicit operator bool() const { return above.pixels() > 0; }
};

// The result, for the visible part. Sky has obscurance 0, error 0 and no rays.
struct Reference {
    struct Channel {
        std::string name;  // of the falloff
        Plane obscurance;
        Plane error;         // estimated standard error of the mean; conservative for few rays
        BentReference bent;  // with WorldOptions::bentNormals
    };
    std::vector<Channel> channels;  // one per falloff, in the order given, from the same rays
    Plane rays;                     // count per pixel
    uint64_t totalRays = 0;
    double seconds = 0.0;  // wall time of casting
    bool fromCache = false;

    float meanError(size_t channel = 0) const;  // over the pixels with rays
    float maxError(size_t channel = 0) const;
    size_t overTarget(float targetError) const;  // pixels with a larger error in any channel: they reached maxRays
};

}  // namespace obscura::truth
