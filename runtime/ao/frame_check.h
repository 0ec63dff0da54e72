// Checks of a frame that a host gives. Private to ao.
#pragma once

#include "ao/context.h"
#include "ao/formats.h"

namespace obscura::ao {

// Which optional images a frame has.
struct GivenImages {
    bool normals = false, motion = false, thickness = false, second = false;
};
// `forecast`: the frame is only asked about, so its images need not exist yet; those with a format count.
GivenImages imagesOf(const Frame& frame, bool forecast);

// Of an image whose part has this size: where the part begins, and the least size of the image.
VkOffset2D originOf(const Frame& frame, VkExtent2D size);
VkExtent2D extentOf(const Frame& frame, VkExtent2D size);

// Whether the frame can be recorded; otherwise a log line that names the field, its value and what would be right. Fills `view`.
Status checkFrame(const Context& context, const Frame& frame, bool forecast, shared::View& view);

}  // namespace obscura::ao
