// The room's door: follows a world and keeps the window of bits around a camera up to date, on a thread of its own. The caller
// copies what changed to the GPU and asks again next frame.
#pragma once

#include <memory>

#include "voxel/resting.h"

namespace obscura::voxel {

struct Options {
    uint32_t cells = 256;            // a side of the window: 64, 128, 256 or 512
    double cellSize = 0.0;           // metres; 0: the world's longest side fills the window, at most 0.14 m
    bool masked = true;              // alpha-masked triangles are occluders, as if they had no holes
    Shell shell = Shell::conservative;
    bool nano = false;               // brings NanoVDB grids of all the world instead of a window's bricks
    bool bits = true;                // false: only where the window stands and how large its cells are; the bits are somebody else's
    std::filesystem::path cache;     // folder of the resting world's .vdb file; empty: nothing is kept
    size_t mostBricks = RasterOptions().mostBricks;
    std::function<void(float)> progress;          // 0 to 1 while what rests is made, 1 at its end; as say
    std::function<void(const std::string&)> say;  // one line each, from the thread that calls update()
};

// What the caller's copy lacks. Bricks are 64 bytes as in bricks.h; a copy starts as zeros.
struct Change {
    uint32_t cells = 0;              // a side; 0: there is no volume yet, or none can be made
    double cellSize = 0.0;           // metres
    glm::ivec3 origin{0};            // lowest cell, a multiple of 8
    std::vector<uint32_t> addresses; // of bricks, ascending: brick (x, y, z) of the world stands at ((x & m) (m+1) + (y & m)) (m+1) + (z & m),
    std::vector<Brick> bricks;       //   m = cells / 8 - 1
    std::vector<uint32_t> grid;      // all that is set, as Sparse::nano() has it; empty: as before, or bricks are brought
};

struct Statistics {
    RestingFacts resting;
    size_t objects = 0, redone = 0;        // that move; of them redone in the newest frame
    uint64_t objectCells = 0, objectBytes = 0;
    uint64_t windowBytes = 0;              // on the GPU, of the bits or of the grid
    uint64_t changedBytes = 0;             // of the newest update
    double workerMilliseconds = 0.0;       // of the newest finished frame, building left out
    double waitMilliseconds = 0.0, worstWait = 0.0;  // of the caller, in update()
    uint64_t late = 0;                     // updates that found the worker still busy and changed nothing
    float progress = 1.0f;                 // of building what rests
};

class Voxels {
public:
    explicit Voxels(Options options);
    ~Voxels();

    // latest: waits 1 ms at most, brings what the worker finished and gives it this frame to work on: one frame behind, more
    // only while it is late. exact: brings this very frame.
    enum class Wait : uint8_t { latest, exact };
    // Valid until the next call. The world is copied; models are shared and must not change.
    const Change& update(const scene::World& world, float time, const glm::vec3& eye, Wait wait);
    // The next change brings every brick: the caller's copy is gone.
    void resend();
    Statistics statistics() const;
    const Options& options() const;

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

}  // namespace obscura::voxel
