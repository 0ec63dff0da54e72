// What both references take and give. A reference is cosine-weighted ray casting: obscurance = mean of rho(distance of the
// first hit) over rays distributed as cos(angle to the normal) / pi, 0 where a ray escapes. 0 open, 1 blocked.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "obscura/ao.h"
#include "truth/picture.h"

namespace obscura::truth {

// Any falloff at all. `rho` maps metres to [0,1] and must not depend on anything but the distance; it is called from
// several threads.
struct RayFalloff {
    std::string name;                  // "quadratic:2": names channels and, with samples of rho, the cached file
    std::function<float(float)> rho;
    float reach = 1.0f;                // metres; rays end here. May be infinite for the world reference only.
    bool hard = false;                 // rho is 1 up to reach: no distance is needed (any hit will do)
};
// The library's falloff. An exponential is followed to 1/65536, not only to the 1/256 at which methods stop.
RayFalloff rayFalloff(const ao::Falloff& falloff);
// "quadratic:2" and the like; throws scene::Error that says how a falloff is written.
RayFalloff rayFalloff(const std::string& text);

// Rays are dealt in batches of 16, each stratified (Owen-scrambled Sobol points) and scrambled by itself, so that the
// scatter of the batches' means gives an honest standard error. A pixel stops when every falloff's standard error is at most
// `targetError` or the limit is reached; minRays == maxRays asks for a fixed count.
struct RayOptions {
    uint32_t minRays = 128;            // rounded up to whole batches, at least two
    uint32_t maxRays = 4096;
    float targetError = 0.005f;        // of obscurance; 0: always maxRays
    uint32_t seed = 1;
    // Only every stride-th visible pixel in x and y; the rest stays 0 with 0 rays. For tests and previews.
    uint32_t stride = 1;
    // Told the share done, 0 to 1, increasing, from the calling thread. Return false to stop: trace() throws scene::Error.
    std::function<bool(float)> progress;
};

inline constexpr uint32_t kBatch = 16;

// Visible part. Sky has obscurance 0, error 0 and no rays.
struct Reference {
    struct Channel {
        std::string name;              // of the falloff
        Plane obscurance;
        Plane error;                   // standard error of the mean, estimated; conservative where rays were few
    };
    std::vector<Channel> channels;     // one a falloff, in the order given: all from the same rays
    Plane rays;                        // cast, a pixel
    uint64_t totalRays = 0;
    double seconds = 0.0;              // wall time of casting
    bool fromCache = false;

    float meanError(size_t channel = 0) const;  // over the pixels with rays
    float maxError(size_t channel = 0) const;
    size_t overTarget(float targetError) const; // pixels whose error is above it in any channel: they hit the ray limit
};

}  // namespace obscura::truth
