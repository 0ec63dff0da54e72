// How calm a picture of obscurance is over time. Planes are visibility of the visible part, as in metrics.h. What moves with
// its surface is no flicker: frames are compared along motion vectors, where the same surface was in sight.
#pragma once

#include <span>

#include "truth/metrics.h"

namespace obscura::truth {

// For every visible pixel where its surface was a frame ago.
struct Correspondence {
    uint32_t width = 0, height = 0;   // visible part
    std::vector<glm::vec2> at;        // px of the visible part, (0, 0) the upper left pixel's centre
    Mask same;                        // 1: the pixels around `at` showed that surface
    Mask disoccluded;                 // 1: none did, or it was out of the picture
    float share() const;              // of pixels that are not sky: `same`
};

// `motion` as render::Outputs::motion: pixels from this frame's position to the last's, whole image. "The same surface": in
// the plane of this pixel's surface within a twentieth of a pixel's width there, normals within 25 degrees, both seen in the world.
// Narrower than a pixel, or the grooves between tiles, which a pixel's middle hits in one frame and misses in the next, would be
// followed as the floor around them and their change counted as the method's.
// Throws scene::Error when sizes differ or a frame has no camera or normals.
Correspondence correspond(const CapturedFrame& now, const CapturedFrame& before, std::span<const glm::vec2> motion);

// A traced picture and each pixel's standard error (empty: exact). Its noise would count as change, so it is taken off.
struct Traced {
    Plane visibility, error;
};

// From one frame to the next, over Correspondence::same. All in visibility, 0 to 1.
struct Change {
    size_t pixels = 0;
    float difference = 0.0f;           // D_A: mean |A_t(p) - A_{t-1}(p - v)|
    float referenceDifference = 0.0f;  // D_R: of the reference, for true obscurance changes too: mean of the root of the 3x3
                                       // mean of the squared change less its variance
    float excess() const { return difference - referenceDifference; }  // F
    float flickerOfError = 0.0f;       // F_e: root mean square of e_t(p) - e_{t-1}(p - v), e = A - R, less the variance of R
    float referenceFlicker = 0.0f;     // F_R: the same of R alone, what F_e is of a picture in which nothing ever changes
};
Change change(const Correspondence& way, const Plane& now, const Plane& before, const Traced& referenceNow, const Traced& referenceBefore);

// Of a camera and a scene that stand still: the standard deviation of every pixel over frames.
class StaticNoise {
public:
    void add(const Plane& visibility);
    size_t frames() const { return m_frames; }
    struct Result { float mean = 0.0f, p99 = 0.0f; };  // of the deviations, over valid pixels
    Result over(const Mask& valid) const;

private:
    size_t m_frames = 0;
    std::vector<double> m_mean, m_squares;
};

// After an occluder (not the receiver) moved or came or went, camera still. `before` is the last picture of the old state, `after`
// those of the new one, the first included, long enough to settle. Judged where the reference changed by more than 0.1
// and the receiver stayed.
struct Lag {
    size_t pixels = 0;
    uint32_t t90 = 0;      // frames until 90 % of the way to the settled picture is done for good: 1 is the first; 0: no pixels
    float ghost = 0.0f;    // G: sum over frames of the mean of what |A-R| exceeds its settled value by, where it grew lighter
};
Lag lag(const Plane& before, std::span<const Plane> after, const Plane& referenceBefore, const Plane& referenceAfter, const Mask& stayed);

// 1 where both frames of a camera that stands still show the same depth within 2 %.
Mask stayed(const CapturedFrame& before, const CapturedFrame& after);

}  // namespace obscura::truth
