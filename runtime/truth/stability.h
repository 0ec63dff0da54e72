// Temporal errors of an obscurance image: flicker, static noise, lag. Planes are visibility of the visible part, as in metrics.h. Frames
// are compared along motion vectors, where both show the same surface, so obscurance that moves with its surface is not flicker.
#pragma once

#include <span>

#include "truth/metrics.h"

namespace obscura::truth {

// Last frame's position of every visible pixel's surface.
struct Correspondence {
    uint32_t width = 0, height = 0;  // visible part
    std::vector<glm::vec2> at;       // px of the visible part, (0, 0) is the centre of the upper left pixel
    Mask same;                       // 1: all pixels around `at` showed that surface
    Mask disoccluded;                // 1: none of them did, or `at` is outside the visible part
    float share() const;             // fraction of the pixels that are not sky with `same`
};

// `motion` as render::Outputs::motion: px from this frame's position to last frame's, whole image. Last frame's pixel shows the same
// surface if it is within 1/20 of a pixel's width of the plane of this pixel's surface, and the normals differ by at most 25 degrees, in
// world space. The tolerance is small because of details below a pixel, such as grooves between tiles, which a pixel's centre hits in one
// frame and misses in the next: with a larger one they would count as floor, and their change as the method's flicker. Throws scene::Error
// if sizes differ or a frame has no camera or normals.
Correspondence correspond(const CapturedFrame& now, const CapturedFrame& before, std::span<const glm::vec2> motion);

// A traced reference and the standard error of each pixel (empty: exact), whose variance is subtracted from measured changes.
struct Traced {
    Plane visibility, error;
};

// From one frame to the next, over Correspondence::same. All in visibility, 0 to 1.
struct Change {
    size_t pixels = 0;
    float difference = 0.0f;           // D_A: mean |A_t(p) - A_{t-1}(p - v)|
    float referenceDifference = 0.0f;  // D_R: of the reference, since true obscurance changes too: mean of sqrt(3x3 mean of (squared
                                       // change - its variance))
    float excess() const { return difference - referenceDifference; }  // F
    float flickerOfError = 0.0f;    // F_e: root mean square of e_t(p) - e_{t-1}(p - v), e = A - R, minus the variance of R
    float referenceFlicker = 0.0f;  // F_R: the same of R alone: F_e of an image that never changes
};
Change change(const Correspondence& way, const Plane& now, const Plane& before, const Traced& referenceNow, const Traced& referenceBefore);

// For a static camera and scene: the standard deviation of every pixel over frames.
class StaticNoise {
public:
    void add(const Plane& visibility);
    size_t frames() const { return m_frames; }
    struct Result {
        float mean = 0.0f, p99 = 0.0f;
    };  // of the deviations, over valid pixels
    Result over(const Mask& valid) const;

private:
    size_t m_frames = 0;
    std::vector<double> m_mean, m_squares;
};

// Lag after an occluder (not the receiver) has moved, appeared or vanished, with a static camera. `before`: the last frame before the
// change; `after`: all frames since, until the image has settled. Evaluated where the reference changed by more than 0.1 and the receiver
// stayed.
struct Lag {
    size_t pixels = 0;
    uint32_t t90 = 0;    // frames until the distance to the settled image stays within 10 % of the one of `before`; 1: the first frame
    float ghost = 0.0f;  // G: sum over frames of the mean excess of |A-R| over its settled value, where the reference became lighter
};
Lag lag(const Plane& before, std::span<const Plane> after, const Plane& referenceBefore, const Plane& referenceAfter, const Mask& stayed);

// 1 where both frames have the same depth within 2 %; for a static camera.
Mask stayed(const CapturedFrame& before, const CapturedFrame& after);

}  // namespace obscura::truth
