#include "measure/false_colour.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "post/false_colour.h"

namespace obscura::measure {

namespace {

uint8_t byteOf(float value) { return uint8_t(std::lround(std::clamp(value, 0.0f, 255.0f))); }

template <class Colour>
app::Picture paint(const truth::Plane& plane, Colour colour) {
    app::Picture picture{plane.width, plane.height, {}};
    picture.rgba.reserve(plane.pixels() * 4);
    for (size_t i = 0; i < plane.pixels(); ++i) {
        const Rgb c = colour(i);
        picture.rgba.insert(picture.rgba.end(), {c.r, c.g, c.b, 255});
    }
    return picture;
}

}  // namespace

Rgb errorColour(float error, float range) {
    const auto& stops = error < 0.0f ? shared::kBelow : shared::kAbove;
    const float t = 2.0f * std::min(std::fabs(error) / range, 1.0f);
    const auto& low = stops[t < 1.0f ? 0 : 1];
    const auto& high = stops[t < 1.0f ? 1 : 2];
    const auto mixed = [&](int channel) { return byteOf(low[channel] + (t < 1.0f ? t : t - 1.0f) * (high[channel] - low[channel])); };
    return {mixed(0), mixed(1), mixed(2)};
}

app::Picture greyPicture(const truth::Plane& visibility) {
    return paint(visibility, [&](size_t i) {
        const uint8_t grey = byteOf(visibility.values[i] * 255.0f);
        return Rgb{grey, grey, grey};
    });
}

app::Picture directionPicture(std::span<const glm::vec3> directions, uint32_t width, uint32_t height) {
    app::Picture picture{width, height, {}};
    for (const glm::vec3& d : directions) {
        const glm::vec3 c = 127.5f + 127.5f * d;
        picture.rgba.insert(picture.rgba.end(), {byteOf(c.x), byteOf(c.y), byteOf(c.z), 255});
    }
    return picture;
}

app::Picture errorPicture(const truth::Plane& visibility, const truth::Plane& reference) {
    assert(visibility.pixels() == reference.pixels());
    return paint(visibility, [&](size_t i) { return errorColour(visibility.values[i] - reference.values[i]); });
}

}  // namespace obscura::measure
