#include "toasters/course.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace obscura::toasters {

namespace {

constexpr float kPi = glm::pi<float>();

}  // namespace

float Course::length() const { return 4.0f * halfStraight + 2.0f * kPi * radius; }

float Course::heading(float distance) const {
    const float lap = std::floor(distance / length());
    const float rest = distance - lap * length();
    const float arc = kPi * radius;
    const float firstArc = std::clamp(rest - halfStraight, 0.0f, arc);
    const float secondArc = std::clamp(rest - 3.0f * halfStraight - arc, 0.0f, arc);
    return -(lap * 2.0f * kPi + (firstArc + secondArc) / radius);
}

glm::vec2 Course::position(float distance) const {
    const float rest = distance - std::floor(distance / length()) * length();
    const float arc = kPi * radius;
    const float turn = -heading(rest);
    const glm::vec2 side = radius * glm::vec2(std::cos(turn), std::sin(turn));
    float along = rest;
    if (rest > 3.0f * halfStraight + arc) along = std::max(rest - length(), -halfStraight);
    else if (rest > halfStraight) along = halfStraight - std::max(rest - halfStraight - arc, 0.0f);
    return centre + glm::vec2(0.0f, along) + side;
}

}  // namespace obscura::toasters
