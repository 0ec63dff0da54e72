// The GPU copy of a scene::Model: vertex streams, indices, textures, what deformation reads. Made once, immutable.
#pragma once

#include <memory>
#include <vector>

#include "gpu/resources.h"
#include "scene/model.h"
#include "scene/world.h"

namespace obscura::render {

// Vertex streams, each packed: position 3 floats; frame (normal, tangent) 8 snorm16; coords (uv0, uv1, colour) 4 floats
// and 4 halves.
inline constexpr uint32_t kPositionBytes = 12, kFrameBytes = 16, kCoordsBytes = 24;

// A primitive, or a chunk of a large rigid one.
struct PrimitiveGpu {
    const scene::Primitive* source = nullptr;
    const scene::Material* material = nullptr;
    uint32_t materialIndex = 0;
    uint32_t vertexCount = 0, indexCount = 0;
    VkDeviceSize positions = 0, frames = 0, coords = 0;  // byte offsets into `vertices`
    VkDeviceSize indices = 0;                            // byte offset into `indices`
    bool skinned = false, morphed = false;
    scene::Bounds bounds;                                // of the rest positions its triangles use
    uint32_t serial = 0;                                 // in its model
    uint32_t part = 0;                                   // of the primitive it is a chunk of, likewise

    // Deformed primitives only, in the units of scene/deform.comp.
    uint32_t restPositions = 0, restFrames = 0, influences = ~0u, targets = 0;
    struct JointBox { uint32_t joint; scene::Bounds box; };
    std::vector<JointBox> jointBoxes;     // rest positions each joint pulls at
    std::vector<glm::vec3> targetReach;   // the largest displacement by axis, per morph target

    bool deformed() const { return skinned || morphed; }
};

class ModelGpu {
public:
    static gpu::Status create(gpu::Device& device, std::shared_ptr<const scene::Model> model, ModelGpu& out);

    std::shared_ptr<const scene::Model> model;
    std::vector<std::vector<PrimitiveGpu>> meshes;  // as Model::meshes: their primitives, in chunks
    gpu::Buffer vertices, indices;
    gpu::Buffer rest, influences, targets;          // empty when nothing deforms
    gpu::Buffer materials;                          // MaterialBlock every kMaterialStride bytes
    std::vector<gpu::Image> images;                 // as Model::images
    uint64_t textureBytes = 0, geometryBytes = 0;
    uint32_t serial = 0;                            // of its renderer: sorts the same every time

    static constexpr VkDeviceSize kMaterialStride = 256;  // the largest alignment Vulkan lets a device ask for
};

}  // namespace obscura::render
