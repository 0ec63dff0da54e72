#include "false_colour.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace obscura::evaluate {

namespace {

struct Stop {
    float at, r, g, b;
};
constexpr Stop kDark[] = {{0.0f, 12, 12, 16}, {0.5f, 32, 96, 200}, {1.0f, 190, 225, 255}};
constexpr Stop kBright[] = {{0.0f, 12, 12, 16}, {0.5f, 208, 88, 16}, {1.0f, 255, 226, 170}};

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
    const Stop* stops = error < 0.0f ? kDark : kBright;
    const float t = std::min(std::fabs(error) / range, 1.0f);
    const Stop& a = t < stops[1].at ? stops[0] : stops[1];
    const Stop& b = t < stops[1].at ? stops[1] : stops[2];
    const float s = (t - a.at) / (b.at - a.at);
    return {byteOf(a.r + s * (b.r - a.r)), byteOf(a.g + s * (b.g - a.g)), byteOf(a.b + s * (b.b - a.b))};
}

app::Picture greyPicture(const truth::Plane& visibility) {
    return paint(visibility, [&](size_t i) {
        const uint8_t grey = byteOf(visibility.values[i] * 255.0f);
        return Rgb{grey, grey, grey};
    });
}

app::Picture errorPicture(const truth::Plane& visibility, const truth::Plane& reference) {
    assert(visibility.pixels() == reference.pixels());
    return paint(visibility, [&](size_t i) { return errorColour(visibility.values[i] - reference.values[i]); });
}

}  // namespace obscura::evaluate
