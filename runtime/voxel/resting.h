// The part of the world that rests, rasterised once and kept on disk: which instances it is made of, whether it still holds, and
// how it comes to be.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "voxel/parts.h"
#include "voxel/sparse.h"

namespace obscura::voxel {

struct RestingFacts {
    uint64_t cells = 0, bricks = 0, triangles = 0;
    uint64_t bytes = 0;         // memory of the OpenVDB grid
    double milliseconds = 0.0;  // that it took to make or load
    bool fromCache = false;
};

class Resting {
public:
    struct Options {
        uint32_t cells = 256;                                // a side of the window
        double cellSize = 0.0;                               // metres; 0: chosen from the world
        Picked picked;
        Shell shell = Shell::conservative;
        bool bits = true;                                    // false: only bounds and cell size are found out
        std::filesystem::path cache;                         // folder; empty: nothing is kept
        size_t mostBricks = RasterOptions().mostBricks;
        std::function<void(const std::string&)> say;         // one line each; from the thread that calls build()
        std::atomic<float>* progress = nullptr;              // 0 to 1 while it builds
    };

    // Whether what was built still is what rests. An instance that was moved is restless from then on: it will not be built in
    // again, so that dragging one does not rebuild the world every frame; until the world loses an instance or becomes another.
    bool holds(const scene::World& world, const Picked& picked);
    // Throws scene::Error, one line, and is empty then.
    void build(const scene::World& world, float time, const Options& options);

    bool contains(uint32_t instance, const Part& part) const { return !part.moves && m_members.count(instance); }
    const Sparse& sparse() const { return m_sparse; }
    const scene::Bounds& bounds() const { return m_bounds; }  // world, of what rests; of everything where nothing does
    double cellSize() const { return m_cellSize; }            // 0: not built
    const RestingFacts& facts() const { return m_facts; }

private:
    struct Member {
        std::shared_ptr<const scene::Model> model;
        glm::mat4 placement{1.0f};
        int animation = 0, root = -1;
        bool is(const scene::Instance& i) const {
            return i.model == model && i.placement == placement && i.animation == animation && i.root == root;
        }
    };
    using Visit = std::function<void(const Posed&)>;
    void forEach(const scene::World& world, float time, const Picked& picked, bool resting, const Visit& visit) const;
    std::string survey(const scene::World& world, float time, const Options& options);
    void rasteriseAll(const scene::World& world, float time, const Options& options);

    std::map<uint32_t, Member> m_members;
    std::set<uint32_t> m_restless;
    Sparse m_sparse;
    scene::Bounds m_bounds;
    double m_cellSize = 0.0;
    bool m_built = false;
    RestingFacts m_facts;
};

}  // namespace obscura::voxel
