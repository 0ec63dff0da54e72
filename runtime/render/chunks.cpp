#include "render/chunks.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace obscura::render {
namespace {

struct Splitter {
    const scene::Primitive& primitive;
    size_t limit;
    Chunks& out;

    glm::vec3 tripleCentre(uint32_t triangle) const {
        const uint32_t* i = &primitive.indices[size_t(triangle) * 3];
        return primitive.positions[i[0]] + primitive.positions[i[1]] + primitive.positions[i[2]];
    }

    void split(std::span<uint32_t> triangles) {
        if (triangles.size() <= limit) {
            std::sort(triangles.begin(), triangles.end());
            for (const uint32_t t : triangles)
                for (size_t corner = 0; corner < 3; ++corner) out.indices.push_back(primitive.indices[size_t(t) * 3 + corner]);
            out.ends.push_back(uint32_t(out.indices.size()));
            return;
        }
        glm::vec3 low = tripleCentre(triangles[0]), high = low;
        for (const uint32_t t : triangles) {
            low = glm::min(low, tripleCentre(t));
            high = glm::max(high, tripleCentre(t));
        }
        const glm::vec3 extent = high - low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const size_t half = triangles.size() / 2;
        std::nth_element(triangles.begin(), triangles.begin() + ptrdiff_t(half), triangles.end(), [&](uint32_t a, uint32_t b) {
            const float x = tripleCentre(a)[axis], y = tripleCentre(b)[axis];
            return x != y ? x < y : a < b;
        });
        split(triangles.first(half));
        split(triangles.subspan(half));
    }
};

}  // namespace

Chunks chunksOf(const scene::Primitive& primitive, size_t limit) {
    Chunks out;
    out.indices.reserve(primitive.indices.size());
    std::vector<uint32_t> triangles(primitive.indices.size() / 3);
    std::iota(triangles.begin(), triangles.end(), 0u);
    Splitter{primitive, std::max<size_t>(limit, 1), out}.split(triangles);
    return out;
}

}  // namespace obscura::render
