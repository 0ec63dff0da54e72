// The pieces a world is made of: what moves as one is rasterised as one.
#pragma once

#include <memory>
#include <vector>

#include "scene/world.h"
#include "voxel/rasterise.h"

namespace obscura::voxel {

// One drawn node of one instance.
struct Part {
    int node = -1;
    bool moves = false;    // by the instance's animation; otherwise it rests for as long as its instance does
    bool deforms = false;  // by skin or morph targets: its shape is another at every time
};

// Blended primitives are no occluders, as in the G-buffer; parts with nothing else are left out.
struct Picked {
    bool masked = true;    // alpha-masked ones are, as if they had no holes
    bool operator()(const scene::Model& model, const scene::Primitive& primitive) const;
};
std::vector<Part> partsOf(const scene::Instance& instance, const Picked& picked);
size_t trianglesOf(const scene::Model& model, const Part& part, const Picked& picked);

// A part's triangles in world space.
struct Posed {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    Triangles triangles() const { return {positions, indices}; }
};
void pose(const scene::Instance& instance, const Part& part, const scene::Pose& pose, const Picked& picked, Posed& out);

}  // namespace obscura::voxel
