// The G-buffer of opaque and masked surfaces. Depth, geometric normals and motion include the guard band, the other images do not.
#pragma once

#include "graph/graph.h"
#include "render/deform.h"
#include "render/materials.h"

namespace obscura::render {

struct GBuffer {
    graph::ImageId depth;      // D32, reversed
    graph::ImageId geometric;  // R32UI, packNormal(), eye space, facing the viewer
    graph::ImageId shaded;     // likewise, interpolated and normal-mapped
    graph::ImageId motion;     // RG16F, px to last frame's position; sky: 0
    graph::ImageId baseColor;  // RGBA8 sRGB, alpha: occlusion map
    graph::ImageId material;   // RGBA8: roughness, metalness, unlit, face (side and solid, shaders/scene/face.glsl)
    graph::ImageId emission;   // B10G11R11F
};

// Vertex bindings 0..3 (position, previous, frame, coords) of shaders/scene/gbuffer.vert.
void addVertexInput(gpu::GraphicsState& state);

class GBufferPass {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, GBufferPass& out);
    gpu::Status prepare(const scene::Material& material) { return m_surface.prepare(material); }
    // `list` must stay valid until the graph has been executed. `frame`: SceneFrame, `items`: DrawItem.
    GBuffer add(graph::Graph& graph, VkExtent2D size, graph::BufferId frame, graph::BufferId items, const DrawList& list,
        const Deform::Posed& posed, Materials& materials);

private:
    gpu::Program m_depth;
    MaterialProgram m_surface;
};

}  // namespace obscura::render
