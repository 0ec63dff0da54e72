// Basic shapes: lofts, lathes, boxes, tubes.
#pragma once

#include "meshkit/mesh.h"

#include <functional>
#include <span>

namespace obscura::kit {

using Ring = std::vector<glm::vec3>;
using Profile = std::vector<glm::vec2>;

/// Chooses a material from the ring a strip starts at and the column within the ring.
using StripMaterial = std::function<std::uint32_t(std::size_t ring, std::size_t column)>;

/// A skin over closed rings of equally many points. Rings run counter-clockwise as seen from the
/// side the loft grows towards; a ring of one repeated point closes an end.
Mesh loft(std::span<const Ring> rings, const StripMaterial& material = {});

/// A ring of |x/hx|^n + |z/hz|^n = 1 at height y: 2 is an ellipse, larger exponents are boxier.
Ring superellipse(glm::vec2 half, float exponent, float y, int segments, glm::vec2 centre = glm::vec2(0.0f));

/// A profile of (radius, height) points turned about the y axis, bottom first.
Mesh lathe(const Profile& profile, int segments, const StripMaterial& material = {});

/// Rounds every inner corner of a polyline; the radius shrinks where the neighbours are close.
Profile fillet(const Profile& corners, float radius, int segments);

/// A ball about the origin.
Mesh sphere(float radius, int segments, int rings);

/// A ring about the y axis.
Mesh torus(float major, float minor, int segments, int sides);

/// A torus drawn out along z into a chain link or a key's bow.
Mesh link(float halfLength, float major, float minor, int segments, int sides);

/// A cylinder along y from 0 to `height` with bevelled ends.
Mesh cylinder(float radius, float height, float bevel, int segments);

/// A box about the origin with edges rounded by `segments` steps.
Mesh roundedBox(glm::vec3 half, float radius, int segments = 1);

/// A box between two corners with single-step chamfers.
Mesh chamferBox(glm::vec3 low, glm::vec3 high, float bevel);

/// A star-shaped outline in the xy plane (counter-clockwise from +z), drawn out from z0 to z1.
Mesh bevelledPrism(std::span<const glm::vec2> outline, float z0, float z1, float bevel);

/// A closed tube along a path.
Mesh tube(std::span<const glm::vec3> path, float radius, int sides);

glm::mat4 translation(glm::vec3 offset);
glm::mat4 rotation(float degrees, glm::vec3 axis);
glm::mat4 scaling(glm::vec3 factor);
/// Turns +y towards a direction.
glm::mat4 aimY(glm::vec3 direction);

}  // namespace obscura::kit
