#pragma once

#include "meshkit/scene.h"

namespace obscura::atrium {

/// Length of the looping animation in seconds.
inline constexpr float kDuration = 10.0f;

/// The whole atrium, animated and ready to write.
kit::Scene buildScene();

} // namespace obscura::atrium
