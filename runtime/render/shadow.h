// The sun's shadow map: one square of reversed depth. Settled objects are drawn into a map that is kept, the others over its copy.
#pragma once

#include "graph/graph.h"
#include "render/deform.h"
#include "render/materials.h"

namespace obscura::render {

struct ShadowRequest {
    std::span<const Drawable> casters;
    glm::vec3 toSun{0.0f, 1.0f, 0.0f};  // unit, world
    glm::vec3 eye{0.0f}, forward{0.0f, 0.0f, -1.0f};
    uint32_t size = 2048;  // texels per side
    float reach = 40.0f;   // metres around the camera that have shadows, in larger worlds
    bool skipMasked = false;
};

class Shadow {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Shadow& out);

    struct Map {
        graph::ImageId image;
        glm::mat4 fromWorld{1.0f};  // xy in [0,1], z reversed depth
        float texel = 0.0f;         // side of a texel, metres
        float depthRange = 1.0f;    // from depth 0 to 1, metres
    };
    // `casters` must stay valid until the graph has been executed.
    Map add(graph::Graph& graph, const ShadowRequest& request, const Deform::Posed& posed, Materials& materials);

private:
    // One of the two maps: of settled objects, and of all objects.
    struct Layer {
        gpu::Image image;
        uint64_t drawn = 0;  // fingerprint of its contents; 0: none
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
