// The GPU copy of a scene::Model: vertex streams, indices, textures, inputs of deformation. Immutable.
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
    scene::Bounds bounds;         // of the rest positions its triangles use
    uint32_t serial = 0;          // index among the model's chunks
    uint32_t primitiveIndex = 0;  // index of its primitive among the model's primitives

    // Deformed primitives only, in the units of scene/deform.comp.
    uint32_t restPositions = 0, restFrames = 0, influences = ~0u, targets = 0;
    struct JointBox {
        uint32_t joint;
        scene::Bounds box;
    };
    std::vector<JointBox> jointBoxes;    // bounds of the rest positions that each joint influences
    std::vector<glm::vec3> targetReach;  // largest displacement per axis, for each morph target

    bool deformed() const { return skinned || morphed; }
};

class ModelGpu {
public:
    static gpu::Status create(gpu::Device& device, std::shared_ptr<const scene::Model> model, ModelGpu& out);

    std::shared_ptr<const scene::Model> model;
    std::vector<std::vector<PrimitiveGpu>> meshes;  // as Model::meshes: their primitives, in chunks
    gpu::Buffer vertices, indices;
    gpu::Buffer rest, influences, targets;  // of deformed primitives; 16 unused bytes without
    gpu::Buffer materials;                  // MaterialBlock every kMaterialStride bytes
    std::vector<gpu::Image> images;         // as Model::images
    uint64_t textureBytes = 0, geometryBytes = 0;
    uint32_t serial = 0;  // order of loading, for a deterministic sort

    static constexpr VkDeviceSize kMaterialStride = 256;  // upper bound of minUniformBufferOffsetAlignment in Vulkan
};

}  // namespace obscura::render
