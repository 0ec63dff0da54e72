// The world that rests, in OpenVDB: a mask grid that holds bricks where there is surface and nothing elsewhere. OpenVDB itself
// is seen by sparse.cpp alone.
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
    Sparse copy() const;
    // Replaces a brick, an empty one by nothing. False: that is what stood there.
    bool put(const glm::ivec3& place, const Brick& brick);
    // False: no such brick. Any number of threads may ask.
    bool find(const glm::ivec3& place, Brick& out) const;
    bool test(const glm::ivec3& cell) const;

    // The same cells as a NanoVDB grid of type mask, which shaders read through PNanoVDB.
    std::vector<uint32_t> nano() const;

    uint64_t cells() const;   // set ones
    uint64_t bricks() const;
    uint64_t bytes() const;   // of memory, OpenVDB's tree included

    // A .vdb file that any OpenVDB tool reads: one mask grid "occupancy" whose transform is the cell size. Behind it stands a line
    // with the bytes' hash, so that a damaged file never reaches OpenVDB's reader. Written to a temporary name, then renamed.
    // Throws scene::Error, one line.
    void save(const std::filesystem::path& file, const std::string& key, double cellSize) const;
    // Throws scene::Error when the file is damaged, or is not of this key.
    static Sparse load(const std::filesystem::path& file, const std::string& key);

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

}  // namespace obscura::voxel
