// A sparse set of bricks: an OpenVDB mask grid with leaves only where there is surface. Only sparse.cpp includes OpenVDB.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "voxel/bricks.h"

namespace obscura::voxel {

class Sparse {
public:
    Sparse();
    ~Sparse();
    Sparse(Sparse&&) noexcept;
    Sparse& operator=(Sparse&&) noexcept;

    void add(const BrickSet& bricks);
    BrickSet bricksOfAll() const;
    // Replaces a brick; an empty one is removed. False if this changes nothing.
    bool put(const glm::ivec3& place, const Brick& brick);
    // False if there is no such brick. Threads may call it concurrently.
    bool find(const glm::ivec3& place, Brick& out) const;
    bool test(const glm::ivec3& cell) const;

    // The same cells as a NanoVDB grid of type mask, which shaders read through PNanoVDB.
    std::vector<uint32_t> nano() const;

    uint64_t cells() const;  // set ones
    uint64_t bricks() const;
    uint64_t bytes() const;  // of memory, OpenVDB's tree included

    // A .vdb file for any OpenVDB tool: one mask grid "occupancy" whose transform is the cell size. A trailing line has the hash of the
    // bytes, so that a damaged file is refused before OpenVDB reads it. Written to a temporary name, then renamed. Throws scene::Error, one
    // line.
    void save(const std::filesystem::path& file, const std::string& key, double cellSize) const;
    // Throws scene::Error if the file is damaged or has another key.
    static Sparse load(const std::filesystem::path& file, const std::string& key);

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

}  // namespace obscura::voxel
