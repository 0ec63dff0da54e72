// Procedural textures of the atrium.
#pragma once

#include "meshkit/image.h"

namespace obscura::atrium {

/// Pale stone with faint bedding.
kit::Image paintStone();
/// Lime plaster with broad stains and fine grain.
kit::Image paintPlaster();
/// Marble for the floor, lightly veined.
kit::Image paintMarble();
/// Broad stripes with a woven border, for banners and awnings.
kit::Image paintCloth();
/// A frond of leaflets; alpha cuts it out.
kit::Image paintLeaf();

}  // namespace obscura::atrium
