// Morphing and skinning on the GPU: one compute pass writes the posed vertices of all deformed primitives. Positions are double-buffered:
// motion vectors need last frame's.
#pragma once

#include "graph/graph.h"
#include "render/actors.h"
#include "render/draw_list.h"
#include "render/model_sets.h"

namespace obscura::render {

class Deform {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Deform& out);

    struct Posed {
        graph::BufferId now, before, frames;
        PosedBuffers buffers;
    };
    // `actors` must not be updated until the graph has been executed.
    Posed add(graph::Graph& graph, const Actors& actors);
    void forget(const ModelGpu& model) { m_rest.forget(model); }

private:
    gpu::Status grow(graph::Graph& graph, uint32_t vertices);

    gpu::Device* m_device = nullptr;
    gpu::Program m_program;
    gpu::Buffer m_positions[2], m_frames;
    uint32_t m_capacity = 0;  // vertices
    uint32_t m_current = 0;
    graph::BufferId m_ids[3];  // this frame's: positions 0 and 1, frames
    ModelSets m_rest;
};

}  // namespace obscura::render
