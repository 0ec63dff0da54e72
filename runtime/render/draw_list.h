// Which drawables are drawn, in which order, with what matrices. Plain CPU work.
#pragma once

#include "render/actors.h"

namespace obscura::render {

// This frame's camera and last frame's, both with this frame's image size.
struct CameraPair {
    glm::mat4 view{1.0f}, projection{1.0f};
    glm::mat4 previousView{1.0f}, previousProjection{1.0f};
    glm::vec3 eye{0.0f};
    bool orthographic = false;
    bool still() const { return view == previousView && projection == previousProjection; }
};

// Half-spaces dot(plane, vec4(p, 1)) >= 0 of a clip volume.
class Frustum {
public:
    explicit Frustum(const glm::mat4& clipFromWorld);
    bool meets(const scene::Bounds& box) const;

private:
    glm::vec4 m_planes[6];
};

// One call: `count` instances of a primitive, their items in a row.
struct Draw {
    const Drawable* first = nullptr;
    uint32_t item = 0, count = 1;
};

struct DrawList {
    std::vector<Draw> opaque, masked, blended;  // near to far; blended far to near
    std::vector<Draw> dear;                     // of opaque: textured, so worth knowing to be seen before they are shaded
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

// Records draws whose pipeline and set 0 are bound. `posed`: positions now, before, frames; `streams` says which of the
// vertex bindings (position, previous, frame, coords) the pipeline has.
struct PosedBuffers { VkBuffer now = VK_NULL_HANDLE, before = VK_NULL_HANDLE, frames = VK_NULL_HANDLE; };
enum Streams : uint32_t { kPosition = 1, kPrevious = 2, kFrame = 4, kCoords = 8 };
using BindMaterial = std::function<void(const ModelGpu& model, uint32_t material)>;
void recordDraws(VkCommandBuffer cmd, const gpu::Api& vk, std::span<const Draw> draws, const PosedBuffers& posed, uint32_t streams,
                 bool cullBackFaces, const BindMaterial& bindMaterial);

// Rows of a 3x4 matrix as shaders want them.
shared::vec4 rowOf(const glm::mat4& matrix, int row);

}  // namespace obscura::render
