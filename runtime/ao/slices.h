// Parameters shared by methods that search slices of the hemisphere through the view ray, as XeGTAO does (shaders/ao/common/slice.glsl).
#pragma once

#include "ao/method.h"

namespace obscura::ao {

enum class SliceBlur : uint32_t { none, edges, surface };
inline constexpr const char* kSliceAxes[] = {"screen", "view ray"};
inline constexpr const char* kSliceBlurs[] = {"none", "edges", "surface"};

inline constexpr Parameter kSlices{
    "slices", "", 1, 32, 3, true, {}, "Slices of the hemisphere around the view ray. Cost grows with slices x steps. Too few: noise."};
inline constexpr Parameter kSliceSteps{"steps", "", 1, 32, 3, true, {},
    "Samples to each side of a slice, out to the falloff's reach. Cost grows with slices x steps. Too few: thin objects are missed."};
inline constexpr Parameter kSliceAxis{"axis", "", 0, 1, 0, true, {kSliceAxes, 2},
    "How slices are spaced: evenly on the screen, as published, or evenly around each pixel's view ray. On the screen they are uneven "
    "away from the image centre."};
inline constexpr Parameter kSliceMipOffset{"mip_offset", "", 0, 30, 3.3f, false, {},
    "Samples farther than 2^this px read coarser depth levels. Lower is faster; too low: distant thin occluders blur."};
inline constexpr Parameter kSliceDenoise{"denoise", "", 0, 2, 1, true, {kSliceBlurs, 3},
    "5x5 blur that removes the noise: stopped at depth edges, as published, or weighted by depth and normal. None: noise shows; "
    "otherwise details of a few pixels soften."};

// The image of a method's raw bent normals; the blur averages as many pixels as XeGTAO's noise needs.
inline RawBentNormals sliceBent(graph::Graph& graph, const Inputs& inputs, const char* name, SliceBlur blur) {
    return {rawBentNormals(graph, inputs.view.visible.x, inputs.view.visible.y, name), 1, blur == SliceBlur::none ? 1u : 4u};
}

}  // namespace obscura::ao
