// Entry of the voxel module: voxelizes a world on its own thread and keeps a window of bits around the camera up to date. The caller calls
// update() every frame and uploads what changed.
#pragma once

#include <memory>

#include "voxel/resting.h"

namespace obscura::voxel {

struct Options {
    uint32_t cells = 256;   // per side of the window: 64, 128, 256 or 512
    double cellSize = 0.0;  // metres; 0: the world's longest side fills the window, at most 0.14 m
    bool masked = true;     // alpha-masked triangles are occluders, as if opaque
    Shell shell = Shell::conservative;
    bool nano = false;            // delivers NanoVDB grids of the whole world instead of bricks of a window
    bool bits = true;             // false: delivers only the window's origin and cell size; the caller makes the bits
    std::filesystem::path cache;  // folder of the .vdb files of static geometry; empty: no cache
    size_t mostBricks = RasterOptions().mostBricks;
    std::function<void(float)> progress;          // 0 to 1 while static geometry is built, 1 at its end; called as say()
    std::function<void(const std::string&)> say;  // log lines, from the thread that calls update()
};

// An update of the caller's copy, which starts as zeros. Brick (x, y, z) of the world has the address
// ((x & m) (m + 1) + (y & m)) (m + 1) + (z & m), with m = cells / 8 - 1, in units of 64 bytes.
struct Change {
    uint32_t cells = 0;               // per side; 0: there is no volume (not built yet, or failed)
    double cellSize = 0.0;            // metres
    glm::ivec3 origin{0};             // lowest cell, a multiple of 8
    std::vector<uint32_t> addresses;  // of `bricks`, ascending
    std::vector<Brick> bricks;        // those that changed
    std::vector<uint32_t> grid;       // the whole grid, Sparse::nano(); empty: unchanged, or not Options::nano
};

struct Statistics {
    RestingFacts resting;
    size_t objects = 0, redone = 0;  // dynamic objects; of them rasterised again in the newest frame
    uint64_t objectCells = 0, objectBytes = 0;
    uint64_t windowBytes = 0;                        // of the bits or the grid on the GPU
    uint64_t changedBytes = 0;                       // of the newest update
    double workerMilliseconds = 0.0;                 // of the newest finished frame, without building static geometry
    double waitMilliseconds = 0.0, worstWait = 0.0;  // of the caller, in update(); milliseconds
    uint64_t late = 0;                               // updates that found the worker busy and changed nothing
    float progress = 1.0f;                           // of building static geometry
};

class Voxels {
public:
    explicit Voxels(Options options);
    ~Voxels();

    // latest: waits at most 1 ms, delivers the worker's last result and starts this frame. One frame of latency, more while the worker is
    // late. exact: waits for the result of this frame.
    enum class Wait : uint8_t { latest, exact };
    // Valid until the next call. The world is copied; models are shared and must not change.
    const Change& update(const scene::World& world, float time, const glm::vec3& eye, Wait wait);
    // The next update delivers every brick: call it when the caller's copy is lost.
    void resend();
    Statistics statistics() const;
    const Options& options() const;

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

}  // namespace obscura::voxel
