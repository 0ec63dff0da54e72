// Voxelization on the GPU: all of the volume's bits, every frame, from the vertices that are drawn. As [Reinbothe 2009, 3.1], but each
// triangle is rasterised along its own dominant axis instead of from random cameras.
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
    // Rasterises all drawables in the windows of all levels except blended ones. `where`: the windows. `drawables` and `posed` must
    // stay valid until the graph has been executed.
    graph::BufferId add(graph::Graph& graph, std::span<const Drawable> drawables, const Deform::Posed& posed, const voxel::Change& where,
        bool masked, voxel::Shell shell);
    void forget(const ModelGpu& model) { m_sets.forget(model); }

private:
    bool bindable(const ModelGpu& model);
    gpu::Device* m_device = nullptr;
    gpu::Program m_program;
    ModelSets m_sets;
    const ModelGpu* m_logged = nullptr;  // the last model that was logged as too large
};

}  // namespace obscura::render
