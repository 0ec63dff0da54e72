// The scene toasters.glb.
#pragma once

#include "meshkit/scene.h"

namespace obscura::toasters {

/// Length of the looping animation in seconds.
inline constexpr float kDuration = 10.0f;

/// The tray with its walking toasters, animated.
kit::Scene buildScene();

}  // namespace obscura::toasters
