// Helpers of the tests of generated content.
#pragma once

#include "meshkit/scene.h"

namespace obscura::content {

/// The generated scenes, built once for all tests.
const kit::Scene& toasters();
const kit::Scene& atrium();

/// Number of edges that do not have exactly one neighbour running the other way. Separate
/// components may share an edge, so only the balance of directions is counted.
int openEdges(const kit::Mesh& mesh, std::uint32_t ignoredMaterial);

}  // namespace obscura::content
