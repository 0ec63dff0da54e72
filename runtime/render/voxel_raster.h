// The volume's bits made on the GPU, all of them every frame, from the vertices that are drawn [Reinbothe 2009, 3.1, without its
// random cameras: each triangle is walked along its own dominant axis].
#pragma once

#include "graph/graph.h"
#include "render/actors.h"
#include "render/deform.h"
#include "voxel/rasterise.h"
#include "voxel/voxels.h"

namespace obscura::render {

class VoxelRaster {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, VoxelRaster& out);
    // Every drawable that reaches into the window and is no blended one. `where` says which window; the drawables and `posed` are
    // of this frame and must stay until the graph has run.
    graph::BufferId add(graph::Graph& graph, std::span<const Drawable> drawables, const Deform::Posed& posed, const voxel::Change& where, bool masked, voxel::Shell shell);
    void forget(const ModelGpu& model) { m_sets.forget(model); }

private:
    bool bindable(const ModelGpu& model);
    gpu::Device* m_device = nullptr;
    gpu::Program m_program;
    ModelSets m_sets;
    const ModelGpu* m_complained = nullptr; // of one that is too large
};

}  // namespace obscura::render
