// The scene atrium.glb.
#pragma once

#include "meshkit/scene.h"

namespace obscura::atrium {

/// Length of the looping animation in seconds.
inline constexpr float kDuration = 10.0f;

/// The whole atrium, animated.
kit::Scene buildScene();

}  // namespace obscura::atrium
