// The volume that methods trace, on the GPU: levels of voxels around the camera. One of: the windows of runtime/voxel, uploaded brick by
// brick as they change; the same windows rasterised on the GPU; a NanoVDB grid of the same bricks.
#pragma once

#include <functional>

#include "ao/prepare.h"
#include "graph/graph.h"
#include "render/voxel_raster.h"
#include "scene/camera.h"
#include "voxel/voxels.h"

namespace obscura::render {

enum class Voxelizer : uint8_t { openvdb, gpu };

// How the world is voxelized for methods that need a volume.
struct Voxelization {
    Voxelizer voxelizer = Voxelizer::openvdb;                    // gpu: everything, every frame
    ao::VolumeStructure structure = ao::VolumeStructure::dense;  // nanovdb: always by the CPU
    voxel::Shell shell = voxel::Shell::conservative;
    uint32_t cells = 256;                 // per side of each level: 64, 128, 256 or 512
    uint32_t levels = 5;                  // 1 to voxel::kMostLevels, each twice as wide as the one before
    float cellSize = 0.0f;                // metres, of level 0; 0: 18 m / cells, less for small worlds
    bool exact = true;                    // each frame waits for its voxels; false: waits at most 1 ms, voxels lag by a frame or more
    std::filesystem::path cache;          // folder of cached static geometry; empty: no cache
    std::function<void(float)> building;  // 0 to 1 while static geometry is built, 1 at its end; from the thread that adds frames
};

class VoxelVolume {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, VoxelVolume& out) {
        return VoxelRaster::create(device, shaders, out.m_raster);
    }

    struct Scene {
        const scene::World& world;
        float time;  // seconds
        const scene::Camera& camera;
        std::span<const Drawable> drawables;  // of the world at that time
        const Deform::Posed& posed;
        bool masked;  // alpha-masked surfaces are occluders
    };
    // Voxelizes the world and adds the upload or the rasterisation. Returns the bits and fills `volume` except its buffer; none while there
    // is no volume.
    graph::BufferId add(graph::Graph& graph, const Scene& scene, const Voxelization& how, ao::Volume& volume);
    void forget(const ModelGpu& model) { m_raster.forget(model); }
    const voxel::Voxels* voxels() const { return m_voxels.get(); }  // null before the first add()

private:
    graph::BufferId upload(graph::Graph& graph, const voxel::Change& change);
    graph::BufferId uploadGrid(graph::Graph& graph, const voxel::Change& change);
    std::unique_ptr<voxel::Voxels> m_voxels;
    Voxelization m_how;
    uint64_t m_frame = 0;  // of the last add()
    bool m_masked = true;
    gpu::Buffer m_bits;  // or the NanoVDB grid
    VoxelRaster m_raster;
};

}  // namespace obscura::render
