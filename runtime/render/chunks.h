// Splits large rigid primitives into spatially compact chunks, for culling and near-to-far order.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/model.h"

namespace obscura::render {

struct Chunks {
    std::vector<uint32_t> indices;  // the primitive's triangles, regrouped
    std::vector<uint32_t> ends;     // one past each chunk's last index; at least one chunk
};

// Splits at the median of the longest axis until a chunk has at most `triangles`. Within a chunk triangles keep their order.
Chunks chunksOf(const scene::Primitive& primitive, size_t triangles);

}  // namespace obscura::render
