// Geometry at rest: the parts of instances that no animation and no move of the instance has moved. Each instance is rasterised once, on a
// thread of its own, and cached on disk; the bricks of all instances are merged into one OpenVDB grid for each level. Adding, moving or
// removing an instance redoes the bricks of that instance alone.
#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "voxel/parts.h"
#include "voxel/sparse.h"
#include "voxel/worker.h"

namespace obscura::voxel {

struct RestingFacts {
    uint64_t cells = 0, bricks = 0;        // of level 0
    uint64_t triangles = 0;                // of all instances, built or not
    uint64_t bytes = 0;                    // memory of all levels and of the instances' own bricks, when the last was built
    double milliseconds = 0.0;             // from the first unbuilt instance to the last built one
    size_t rasterised = 0, fromCache = 0;  // instances, since the cell size was chosen
};

class Resting {
public:
    struct Options {
        uint32_t cells = 256;  // per side of a window
        uint32_t levels = 5;
        double cellSize = 0.0;  // metres; 0: chosen from the world
        Picked picked;
        Shell shell = Shell::conservative;
        bool bits = true;                                // false: computes the cell size only
        std::filesystem::path cache;                     // folder; empty: no cache
        size_t cachedTriangles = 65536;                  // instances with fewer are faster to rasterise than worth a file
        size_t mostBricks = RasterOptions().mostBricks;  // of all instances
        std::function<void(const std::string&)> say;     // log lines, from the thread that calls update()
        std::atomic<float>* progress = nullptr;          // 0 to 1 while instances are built
    };

    explicit Resting(Options options);
    ~Resting();  // gives up what is being built

    // Follows the world: queues new instances, drops what is gone. An instance that was moved counts as dynamic until it is removed. The
    // bricks of finished ones are merged, up to a limit per call, so that a call takes a few milliseconds. `wait`: returns when everything
    // is built and merged. Appends the places of level 0 that changed. True if a new world was found (no instance of the last call is
    // left): the cell size may differ, and all bricks of before are void.
    bool update(const scene::World& world, float time, bool wait, std::vector<glm::ivec3>& changed);

    // Whether the part is at rest, built or not.
    bool contains(uint32_t instance, const Part& part) const { return !part.moves && m_members.count(instance); }
    // False if there is no such brick.
    bool find(const glm::ivec3& place, uint32_t level, Brick& out) const { return m_levels[level].find(place, out); }
    const Sparse& level(uint32_t k) const { return m_levels[k]; }
    double cellSize() const { return m_cellSize; }  // metres; 0: update() was not called
    RestingFacts facts() const;

private:
    struct Member {
        scene::Instance instance;
        BrickSet bricks;
        glm::ivec3 low{0}, high{-1};  // of `bricks`
        size_t merged = 0;            // bricks of the first so many
        size_t triangles = 0;
        bool built = false;
        bool matches(const scene::Instance& other) const;
    };
    struct Build {  // of one instance, by m_builder
        uint32_t id;
        scene::Instance instance;
        size_t triangles;
        BrickSet bricks;
        bool fromCache = false;
        std::vector<std::string> lines;
        std::string refusal;  // why it has no bricks
    };
    bool isNewWorld(const scene::World& world) const;
    void restart(const scene::World& world, float time);
    void follow(const scene::World& world, std::vector<glm::ivec3>& changed);
    void drop(uint32_t id, std::vector<glm::ivec3>& changed);
    void startBuild(float time);
    void collectBuilds();
    bool merge(size_t most, std::vector<glm::ivec3>& changed);
    void build(Build& build, float time, size_t mostBricks);
    void report();
    void count();  // m_facts.bytes, which visits every brick

    const Options m_options;
    double m_cellSize = 0.0;
    std::map<uint32_t, std::shared_ptr<const scene::Model>> m_known;  // instances of the last call
    std::map<uint32_t, Member> m_members;
    std::set<uint32_t> m_dynamic;
    std::vector<Sparse> m_levels;
    std::deque<uint32_t> m_queue, m_merging;  // members to be built, and to be merged
    std::chrono::steady_clock::time_point m_begun;
    std::string m_refusal;  // the first since the last log line
    size_t m_refused = 0;
    RestingFacts m_facts;  // without cells, bricks and triangles
    // Owned by m_builder while it runs.
    std::vector<Build> m_builds;
    std::atomic<bool> m_cancel{false};
    std::atomic<uint64_t> m_doneTriangles{0};  // of the queue since it was empty
    uint64_t m_allTriangles = 0;
    Worker m_builder;  // last member: its thread ends before the others are destroyed
};

}  // namespace obscura::voxel
