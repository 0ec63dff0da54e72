// Meshes and proportions of a toaster.
#pragma once

#include "meshkit/mesh.h"

namespace obscura::toasters {

/// Material slots shared by every part of a toy and by the tray.
enum Slot : std::uint32_t { kPaint, kChrome, kBrass, kMouth, kEnamel, kPupil, kRubber, kBread, kCrust, kWood, kDarkWood, kSlotCount };

/// Joints of the leg skin, in order.
enum Joint : std::uint8_t { kHipLeft, kKneeLeft, kAnkleLeft, kHipRight, kKneeRight, kAnkleRight, kJointCount };

// A toy faces +z with its left side at +x; its root stands on the ground between the feet.
// In the bind pose the legs are straight and the body's origin is level with the hips.
inline constexpr float kHipHeight = 0.19f;
inline constexpr float kHipSide = 0.07f;
inline constexpr float kLegSegment = 0.075f;
inline constexpr float kAnkleHeight = kHipHeight - 2.0f * kLegSegment;

/// The head's hinge, from the body's origin.
inline constexpr glm::vec3 kHinge{0.0f, 0.105f, -0.135f};
/// The key's bearing, from the body's origin; the key turns about z.
inline constexpr glm::vec3 kKeyBearing{0.0f, 0.04f, -0.155f};
/// The toast's middle while it rests in the slot, from the hinge.
inline constexpr glm::vec3 kToastSeat{0.0f, 0.152f, 0.135f};
/// The left eye's middle, from the hinge; the right one mirrors it.
inline constexpr glm::vec3 kEye{0.066f, 0.088f, 0.252f};

kit::Geometry makeJaw();
kit::Geometry makeHead();
kit::Geometry makeEye();
kit::Geometry makeKey();
/// Both legs in the toy's root space, with weights for the joints above.
kit::Geometry makeLegs();
/// A slice with one morph target that bends its upper part forwards.
kit::Geometry makeToast();

}  // namespace obscura::toasters
