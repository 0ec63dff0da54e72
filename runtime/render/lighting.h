// Lighting from linear depth, G-buffer, visibility and shadow map, then blended surfaces; and tone mapping.
#pragma once

#include "render/gbuffer.h"
#include "render/renderer.h"
#include "render/shadow.h"
#include "shared/view.h"

namespace obscura::render {

class Lighting {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Lighting& out);

    gpu::Status prepare(const scene::Material& material) { return m_blend.prepare(material); }

    struct Inputs {
        GBuffer gbuffer;
        graph::ImageId linearDepth;  // as ao::Inputs::depth
        graph::ImageId visibility;
        graph::ImageId bentNormals;  // optional: as Outputs::bentNormals
        Shadow::Map shadow;
        shared::View view;
        glm::mat4 eyeFromWorld{1.0f};
        Sun sun;
        graph::BufferId frame, items;  // of the G-buffer
        const DrawList* draws = nullptr;
        Deform::Posed posed;
    };
    // Returns linear radiance, R16G16B16A16_SFLOAT: as large as the depth buffer, lit in the visible part only. `draws` must stay valid
    // until the graph has been executed.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, Materials& materials);
    // The picture of linear radiance with or without guard band: R8G8B8A8_UNORM, sRGB-encoded, visible size.
    graph::ImageId toneMap(graph::Graph& graph, graph::ImageId lit, const shared::View& view, float exposure);

private:
    gpu::Program m_light[2], m_tonemap;  // m_light: without and with bent normals
    MaterialProgram m_blend;
};

}  // namespace obscura::render
