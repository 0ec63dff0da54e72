// Temporal anti-aliasing of lit radiance (shaders/post/antialias.comp), and the jitter that it averages.
#pragma once

#include "graph/graph.h"
#include "render/draw_list.h"
#include "shared/view.h"

namespace obscura::render {

// px, x right, y down: how far the image is moved in a frame. Eight phases of Halton's sequence in bases 2 and 3, in [-1/2, 1/2); that of
// frame 0 is 0, so that a single frame is the one without anti-aliasing.
glm::vec2 antialiasJitter(uint64_t frame);

class Antialias {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Antialias& out);

    struct Inputs {
        graph::ImageId lit;          // R16G16B16A16_SFLOAT, linear radiance; this and the following guard band included
        graph::ImageId linearDepth;  // as Outputs::linearDepth
        graph::ImageId motion;       // as Outputs::motion
        shared::View view;
        CameraPair camera;  // both with this frame's jitter
        float exposure = 1.0f;
        bool cut = false;  // history is discarded
    };
    // The resolved image, as `lit` but of visible size. It is the history of the next frame: 16 bytes a visible pixel in all.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs);
    void skip(graph::Graph& graph);  // a frame without: the history is too old for the next

private:
    gpu::Program m_resolve;
    graph::History m_history;
};

}  // namespace obscura::render
