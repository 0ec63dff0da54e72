// False colours of errors, and greys of visibility.
#pragma once

#include <span>

#include <glm/glm.hpp>

#include "app/picture.h"
#include "truth/picture.h"

namespace obscura::measure {

inline constexpr float kErrorRange = 0.25f;  // error at which the colours saturate

struct Rgb {
    uint8_t r, g, b;
};
// Of an error A - R of visibility, in the ramp of shaders/post/false_colour.h: blue where the picture is too dark, orange where it is
// too bright. tools/evaluate/page/gallery.js has the same ramp.
Rgb errorColour(float error, float range = kErrorRange);

app::Picture greyPicture(const truth::Plane& visibility);  // byte = 255 * value, without sRGB encoding
app::Picture directionPicture(std::span<const glm::vec3> directions, uint32_t width, uint32_t height);  // byte = 127.5 + 127.5 component
app::Picture errorPicture(const truth::Plane& visibility, const truth::Plane& reference);

}  // namespace obscura::measure
