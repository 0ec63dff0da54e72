// The sun's shadow map: one square of reversed depth. What has been at rest for a while is drawn once and kept; what moves
// is drawn over a copy of that.
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
    // One of the two maps: things at rest, and those with the moving ones on top.
    struct Layer {
        gpu::Image image;
        uint64_t drawn = 0;  // fingerprint of what it shows; 0: nothing yet
        std::vector<Draw> solid, masked;
    };
    void collect(Layer& layer, std::vector<const Drawable*> casters, const glm::mat4& clip);
    graph::ImageId import(graph::Graph& graph, const Layer& layer, const char* name);
    void draw(graph::Graph& graph, const char* name, Layer& layer, graph::ImageId target, std::optional<float> clear, graph::BufferId items,
              const Deform::Posed& posed, Materials& materials);

    gpu::Device* m_device = nullptr;
    gpu::Program m_solid, m_masked;
    Layer m_resting, m_moving;
    std::vector<shared::ShadowItem> m_items;
};

}  // namespace obscura::render
