// Meshes of the atrium's building elements and furnishings.
#pragma once

#include "atrium/atrium_layout.h"
#include "meshkit/mesh.h"

#include <glm/glm.hpp>

namespace obscura::atrium {

/// A fluted column with base and capital, standing on y = 0.
kit::Geometry makeColumn(float height);
/// A square pier for the court's corners, as high as a column.
kit::Geometry makePier(float height);
/// One bay of arcade from springing line to the storey's floor, along x, centred on the origin.
/// A blind arch is for setting half into a wall.
kit::Geometry makeArch(bool isBlind);
/// A turned baluster, and one bay of plinth and hand rail for it to stand between.
kit::Geometry makeBaluster();
kit::Geometry makeRail();
/// Number and spacing of the balusters in a bay.
inline constexpr int kBalusters = 6;
inline constexpr float kBalusterSpacing = 0.32f;

/// Bevelled tiles for the floor: the court or the walk round it.
kit::Geometry makeCourtFloor();
kit::Geometry makeWalkFloor();
/// The floor of the upper storey or the roof over it: a ring of slab with beams beneath.
kit::Geometry makeSlab(float bottom, float top);
/// The outer walls with their pilasters.
kit::Geometry makeOuterWalls();
/// The moulding that runs round the court below height y.
kit::Geometry makeCornice(float y, float projection);
/// One bay of brackets that carry a cornice whose top is at y = 0; +z faces the court.
kit::Geometry makeBrackets();

kit::Geometry makePot();
/// A plant of crossed cards cut out by the leaf texture.
kit::Geometry makePlant();
kit::Geometry makeChainLink();
kit::Geometry makeLantern();
kit::Geometry makeBench();

/// A banner that hangs from a rod: origin at the middle of the rod, falling along -y, facing z.
kit::Geometry makeBanner(float width, float height);
kit::Geometry makeBannerRod(float width);
/// A cloth slung across the court along z, sagging from both ends at y = 0.
kit::Geometry makeAwning(float width, float span, float sag);

}  // namespace obscura::atrium
