// Static geometry: rasterised once and cached on disk. Tracks which instances it contains and whether they have changed.
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
    double milliseconds = 0.0;  // to build or load
    bool fromCache = false;
};

class Resting {
public:
    struct Options {
        uint32_t cells = 256;   // per side of the window
        double cellSize = 0.0;  // metres; 0: chosen from the world
        Picked picked;
        Shell shell = Shell::conservative;
        bool bits = true;             // false: computes bounds and cell size only
        std::filesystem::path cache;  // folder; empty: no cache
        size_t mostBricks = RasterOptions().mostBricks;
        std::function<void(const std::string&)> say;  // log lines, from the thread that calls build()
        std::atomic<float>* progress = nullptr;       // 0 to 1 while it builds
    };

    // False if the static geometry must be built again. An instance that was moved counts as dynamic in later builds, so that dragging it
    // does not rebuild the grid every frame. This is reset when the world loses an instance or an instance gets another model.
    bool holds(const scene::World& world, const Picked& picked);
    // Throws scene::Error, one line; it is then empty.
    void build(const scene::World& world, float time, const Options& options);

    bool contains(uint32_t instance, const Part& part) const { return !part.moves && m_members.count(instance); }
    const Sparse& sparse() const { return m_sparse; }
    const scene::Bounds& bounds() const { return m_bounds; }  // of the static geometry, world space; of all geometry if none is static
    double cellSize() const { return m_cellSize; }            // 0: not built
    const RestingFacts& facts() const { return m_facts; }

private:
    struct Member {
        std::shared_ptr<const scene::Model> model;
        glm::mat4 placement{1.0f};
        int animation = 0, root = -1;
        bool matches(const scene::Instance& i) const {
            return i.model == model && i.placement == placement && i.animation == animation && i.root == root;
        }
    };
    using Visit = std::function<void(const Posed&)>;
    void forEach(const scene::World& world, float time, const Picked& picked, bool resting, const Visit& visit) const;
    std::string measure(const scene::World& world, float time, const Options& options);
    void rasteriseAll(const scene::World& world, float time, const Options& options);

    std::map<uint32_t, Member> m_members;
    std::set<uint32_t> m_dynamic;
    Sparse m_sparse;
    scene::Bounds m_bounds;
    double m_cellSize = 0.0;
    bool m_built = false;
    RestingFacts m_facts;
};

}  // namespace obscura::voxel
