// Writes a scene as GLB 2.0.
#pragma once

#include "meshkit/scene.h"

#include <cstdint>
#include <vector>

namespace obscura::kit {

/// The scene as the bytes of a GLB 2.0 file. The same scene always gives the same bytes.
std::vector<std::uint8_t> writeGlb(const Scene& scene);

}  // namespace obscura::kit
