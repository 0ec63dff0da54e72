// Parameters of methods that search slices of the hemisphere through the view ray as XeGTAO does (shaders/ao/common/slice.glsl).
#pragma once

#include "ao/method.h"

namespace obscura::ao {

enum class SliceBlur : uint32_t { none, edges, surface };
inline constexpr const char* kSliceAxes[] = {"screen", "view ray"};
inline constexpr const char* kSliceBlurs[] = {"none", "edges", "surface"};

inline constexpr Parameter kSlices{"slices", "", 1, 32, 3, true, {}, "Slices of the hemisphere through the view ray; cost grows with slices x steps."};
inline constexpr Parameter kSliceSteps{"steps", "", 1, 32, 3, true, {}, "Samples to each side of a slice, out to the falloff's reach."};
inline constexpr Parameter kSliceAxis{"axis", "", 0, 1, 0, true, {kSliceAxes, 2},
                                      "Where slices lie evenly: on the screen as published, or around each pixel's view ray, which is right off the picture's centre."};
inline constexpr Parameter kSliceMipOffset{"mip_offset", "", 0, 30, 3.3f, false, {}, "Samples farther than 2 to this, px, come from coarser depths: kinder to caches, softer."};
inline constexpr Parameter kSliceDenoise{"denoise", "", 0, 2, 1, true, {kSliceBlurs, 3}, "5x5 over the noise: cut at edges of depth as published, or along the surface."};

// XeGTAO's presets; its high is the initial values.
inline constexpr Setting kSlicesLow[] = {{"slices", 1}, {"steps", 2}};
inline constexpr Setting kSlicesMedium[] = {{"slices", 2}, {"steps", 2}};
inline constexpr Setting kSlicesUltra[] = {{"slices", 9}};

}  // namespace obscura::ao
