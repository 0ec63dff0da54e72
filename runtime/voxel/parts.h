// Parts, the units of rasterisation: drawn nodes of instances.
#pragma once

#include <memory>
#include <vector>

#include "scene/world.h"
#include "voxel/rasterise.h"

namespace obscura::voxel {

struct Part {
    int node = -1;
    bool moves = false;    // under the instance's animation; else it moves with its instance only
    bool deforms = false;  // by skin or morph targets: its shape depends on time
};

// Selects the primitives that are occluders. Blended ones are not, as in the G-buffer; parts without occluders are skipped.
struct Picked {
    bool masked = true;  // alpha-masked primitives are occluders, as if opaque
    bool operator()(const scene::Model& model, const scene::Primitive& primitive) const;
};
std::vector<Part> partsOf(const scene::Instance& instance, const Picked& picked);
size_t trianglesOf(const scene::Model& model, const Part& part, const Picked& picked);

// Bounds of a part's vertices before skinning, morph targets at full weight included, in the node's space.
scene::Bounds boundsOf(const scene::Model& model, const Part& part, const Picked& picked);
// World-space bounds that contain the posed part. `own`: boundsOf() of it.
scene::Bounds boundsOf(const scene::Instance& instance, const Part& part, const scene::Pose& pose, const scene::Bounds& own);

// A part's triangles in world space.
struct Posed {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    Triangles triangles() const { return {positions, indices}; }
};
void pose(const scene::Instance& instance, const Part& part, const scene::Pose& pose, const Picked& picked, Posed& out);

}  // namespace obscura::voxel
