// Builds the frame's draws on the CPU: culling, order, instancing, matrices; and records them.
#pragma once

#include "render/actors.h"

namespace obscura::render {

// This frame's camera and last frame's, both with this frame's image size.
struct CameraPair {
    glm::mat4 view{1.0f}, projection{1.0f};
    glm::mat4 previousView{1.0f}, previousProjection{1.0f};
    glm::vec3 eye{0.0f};
    glm::vec2 jitter{0.0f};  // px, x right, y down: by which both projections move the image
    bool orthographic = false;
    bool still() const { return view == previousView && projection == previousProjection; }
};

// Half-spaces dot(plane, vec4(p, 1)) >= 0 of a clip volume.
class Frustum {
public:
    explicit Frustum(const glm::mat4& clipFromWorld);
    bool intersects(const scene::Bounds& box) const;

private:
    glm::vec4 m_planes[6];
};

// One draw call: `count` instances of a primitive, with consecutive items.
struct Draw {
    const Drawable* first = nullptr;
    uint32_t item = 0, count = 1;
};

struct DrawList {
    std::vector<Draw> opaque, masked, blended;  // near to far; blended far to near
    std::vector<Draw> textured;                 // subset of opaque, drawn in the depth prepass
    std::vector<shared::DrawItem> items;
    size_t drawables = 0, triangles = 0, drawn = 0;  // drawn: triangles after culling
    size_t draws() const { return opaque.size() + masked.size() + blended.size(); }
};

struct DrawOptions {
    bool cull = true;
    bool skipMasked = false;
    bool cut = false;  // motion is 0
};
// `drawables` must outlive the list.
DrawList buildDraws(std::span<const Drawable> drawables, const CameraPair& camera, const DrawOptions& options);

// Records draws; pipeline and descriptor set 0 must be bound. `posed`: positions of this and last frame, tangent frames. `streams`: the
// pipeline's vertex bindings, as Streams.
struct PosedBuffers {
    VkBuffer now = VK_NULL_HANDLE, before = VK_NULL_HANDLE, frames = VK_NULL_HANDLE;
};
enum Streams : uint32_t { kPosition = 1, kPrevious = 2, kFrame = 4, kCoords = 8 };
using BindMaterial = std::function<void(const ModelGpu& model, uint32_t material)>;
void recordDraws(VkCommandBuffer cmd, const gpu::Api& vk, std::span<const Draw> draws, const PosedBuffers& posed, uint32_t streams,
    bool cullBackFaces, const BindMaterial& bindMaterial);

// A row of a matrix, for the 3x4 matrices of shaders.
shared::vec4 rowOf(const glm::mat4& matrix, int row);

}  // namespace obscura::render
