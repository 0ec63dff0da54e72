// The voxels' copy on the GPU: follows runtime/voxel's window and uploads what changed in it, brick by brick.
#pragma once

#include "ao/prepare.h"
#include "graph/graph.h"
#include "scene/camera.h"
#include "voxel/voxels.h"

namespace obscura::render {

// How the world is voxelized for methods that need a volume.
struct Voxelization {
    uint32_t cells = 256;         // a side of the window on the GPU: 64, 128, 256 or 512
    float cellSize = 0.0f;        // metres; 0: the world's longest side fills the window, at most 0.14 m
    bool exact = true;            // every frame waits for its own voxels; else they may be a frame behind and nobody waits
    std::filesystem::path cache;  // folder where what rests is kept; empty: nowhere
    bool operator==(const Voxelization&) const = default;
};

class VoxelVolume {
public:
    // Follows the world; adds the upload. Returns the bits and fills `volume`, its buffer aside; none where there is no volume (yet).
    graph::BufferId add(graph::Graph& graph, const scene::World& world, float time, const scene::Camera& camera, const Voxelization& how, bool masked,
                        ao::Volume& volume);
    const voxel::Voxels* voxels() const { return m_voxels.get(); }  // null before the first add()

private:
    std::unique_ptr<voxel::Voxels> m_voxels;
    Voxelization m_how;
    bool m_masked = true;
    gpu::Buffer m_bits;
};

}  // namespace obscura::render
