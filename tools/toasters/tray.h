// The tray on which the toasters walk.
#pragma once

#include "meshkit/mesh.h"

namespace obscura::toasters {

/// The tray's floor, which the toys walk on.
inline constexpr float kTrayFloor = 0.06f;

/// A wooden tray standing on y = 0, with a raised rim and round recesses in its floor.
kit::Geometry makeTray();

}  // namespace obscura::toasters
