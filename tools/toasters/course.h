// The closed path that a toaster walks.
#pragma once

#include <glm/glm.hpp>

namespace obscura::toasters {

/// A closed walk on the tray: two straights along z joined by half circles.
/// Distance 0 is the middle of the straight on the +x side, and grows towards +z there.
struct Course {
    glm::vec2 centre{0.0f};
    float halfStraight = 0.5f;
    float radius = 0.5f;

    float length() const;
    /// The place (x, z) after walking `distance`.
    glm::vec2 position(float distance) const;
    /// The turn about y that faces a walker along the course; without jumps over many laps.
    float heading(float distance) const;
};

}  // namespace obscura::toasters
