// Entry of the voxel module: voxelizes a world on its own thread and keeps windows of bits around the camera up to date, one for each level
// of cell sizes. The caller calls update() every frame and uploads what changed.
#pragma once

#include <memory>

#include "voxel/nano_grid.h"
#include "voxel/resting.h"

namespace obscura::voxel {

struct Options {
    uint32_t cells = 256;   // per side of a window: 64, 128, 256 or 512
    uint32_t levels = 5;    // windows, each with cells twice as large as the one before; 1 to kMostLevels
    double cellSize = 0.0;  // metres, of level 0; 0: 18 m / cells, less in a world that fits into the finest window
    bool masked = true;     // alpha-masked triangles are occluders, as if opaque
    Shell shell = Shell::conservative;
    bool nano = false;            // delivers the windows' cells as a NanoVDB grid instead of bricks
    bool bits = true;             // false: delivers only the windows' places and the cell size; the caller makes the bits
    std::filesystem::path cache;  // folder of the .vdb files of geometry at rest; empty: no cache
    size_t mostBricks = RasterOptions().mostBricks;
    std::function<void(float)> progress;          // 0 to 1 while geometry at rest is built, 1 at its end; called as say()
    std::function<void(const std::string&)> say;  // log lines, from the thread that calls update()
};
inline constexpr uint32_t kMostLevels = 8;

// An update of the caller's copy, which starts as zeros: one cube of bricks for each level, one after another. Brick (x, y, z) of level k
// has the address k (m + 1)^3 + ((x & m) (m + 1) + (y & m)) (m + 1) + (z & m), with m = cells / 8 - 1, in units of 64 bytes.
struct Change {
    uint32_t cells = 0;  // per side; 0: there is no volume (not built yet)
    uint32_t levels = 0;
    double cellSize = 0.0;            // metres, of level 0
    glm::ivec3 origin{0};             // lowest cell of level 0, a multiple of 8
    std::vector<uint32_t> addresses;  // of `bricks`, ascending
    std::vector<Brick> bricks;        // those that changed
    // With Options::nano, instead of bricks: ranges of a NanoVDB grid that changed, and their words one after another. It has the brick of
    // level k and address (x (m + 1) + y) (m + 1) + z at (k (m + 1) + x, y, z).
    uint64_t gridBytes = 0;  // of the grid; where it differs from the last update, all words follow
    std::vector<NanoGrid::Range> gridRanges;
    std::vector<uint32_t> grid;

    glm::ivec3 centreBrick() const { return origin / kBrickSide + int(cells / kBrickSide / 2); }
    uint64_t bytes() const { return uint64_t(levels) * cells * cells * cells / 8; }  // of all bricks
};

struct Statistics {
    RestingFacts resting;
    size_t objects = 0, redone = 0;  // dynamic objects; of them rasterised again in the newest frame
    uint64_t objectCells = 0, objectBytes = 0;
    uint64_t windowBytes = 0;                        // of the bits of all levels, or of the grid, on the GPU
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
    // late. current: waits for the result of this frame, but not for geometry at rest that is being built. exact: waits for that, too.
    enum class Wait : uint8_t { latest, current, exact };
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
