// The sun's shadow map: one square of reversed depth, drawn again only when something that casts has changed.
#pragma once

#include "graph/graph.h"
#include "render/deform.h"
#include "render/materials.h"

namespace obscura::render {

struct ShadowRequest {
    std::span<const Drawable> casters;
    glm::vec3 toSun{0.0f, 1.0f, 0.0f};   // unit, world
    glm::vec3 eye{0.0f}, forward{0.0f, 0.0f, -1.0f};
    uint32_t size = 2048;                // texels a side
    float reach = 40.0f;                 // metres around the camera that get shadows, in worlds larger than that
    bool skipMasked = false;
};

class Shadow {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Shadow& out);

    struct Map {
        graph::ImageId image;
        glm::mat4 fromWorld{1.0f};  // xy in [0,1], z reversed depth
        float texel = 0.0f;         // metres
    };
    // `casters` must stay until the graph has run.
    Map add(graph::Graph& graph, const ShadowRequest& request, const Deform::Posed& posed, Materials& materials);

private:
    gpu::Device* m_device = nullptr;
    gpu::Program m_solid, m_masked;
    gpu::Image m_image;
    uint64_t m_drawn = 0;  // fingerprint of what the map shows; 0: nothing yet
    std::vector<Draw> m_solidDraws, m_maskedDraws;
    std::vector<shared::ShadowItem> m_items;
};

}  // namespace obscura::render
