#include "render/voxel_volume.h"

#include <algorithm>
#include <cstring>

namespace obscura::render {
namespace {

using voxel::Brick;

// Merges copies of consecutive bricks.
std::vector<VkBufferCopy> copies(const std::vector<uint32_t>& addresses, uint64_t source) {
    std::vector<VkBufferCopy> list;
    for (size_t i = 0; i < addresses.size(); ++i) {
        if (i > 0 && addresses[i] == addresses[i - 1] + 1) list.back().size += sizeof(Brick);
        else list.push_back({source + i * sizeof(Brick), uint64_t(addresses[i]) * sizeof(Brick), sizeof(Brick)});
    }
    return list;
}

// regions: of `from` to `to`.
void addCopy(graph::Graph& graph, graph::BufferId from, graph::BufferId to, std::vector<VkBufferCopy> regions) {
    graph.pass("voxels.upload")
        .use(from, graph::Access::transferRead)
        .use(to, graph::Access::transferWrite)
        .record([from, to, regions = std::move(regions)](const graph::PassContext& c) mutable {
            const graph::ExternalBuffer source = c.buffer(from), target = c.buffer(to);
            for (VkBufferCopy& region : regions) region.srcOffset += source.offset;
            c.device.vk().CmdCopyBuffer(c.cmd, source.buffer, target.buffer, uint32_t(regions.size()), regions.data());
        });
}

}  // namespace

graph::BufferId VoxelVolume::upload(graph::Graph& graph, const voxel::Change& change) {
    const uint64_t bytes = change.bytes();
    std::vector<Brick> first;
    if (!m_bits) {  // a new buffer is written completely, empty bricks included
        if (gpu::Buffer::create(graph.device(), bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                gpu::Memory::device, "voxels", m_bits) != gpu::Status::ok)
            return {};
        first.resize(bytes / sizeof(Brick));
        for (size_t i = 0; i < change.addresses.size(); ++i) first[change.addresses[i]] = change.bricks[i];
    }
    const graph::BufferId bits = graph.import("voxels", m_bits, graph::Graph::Shared::written);
    const std::vector<Brick>& sent = first.empty() ? change.bricks : first;
    if (sent.empty()) return bits;
    const graph::BufferId staged = graph.upload("voxel bricks", sent.data(), sent.size() * sizeof(Brick));
    std::vector<VkBufferCopy> regions = first.empty() ? copies(change.addresses, 0) : std::vector<VkBufferCopy>{{0, 0, bytes}};
    addCopy(graph, staged, bits, std::move(regions));
    return bits;
}

graph::BufferId VoxelVolume::uploadGrid(graph::Graph& graph, const voxel::Change& change) {
    if (change.gridBytes != m_bits.bytes()) {
        m_bits = {};
        if (change.gridBytes > graph.device().caps().maxStorageRange) {
            graph.device().log(
                gpu::Severity::warning, "voxels: the NanoVDB grid exceeds this device's maxStorageBufferRange; use larger cells");
            return {};
        }
        if (gpu::Buffer::create(graph.device(), change.gridBytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                gpu::Memory::device, "voxel grid", m_bits) != gpu::Status::ok)
            return {};
    }
    const graph::BufferId grid = graph.import("voxel grid", m_bits, graph::Graph::Shared::written);
    if (change.grid.empty()) return grid;
    const graph::BufferId staged = graph.upload("voxel grid changes", change.grid.data(), change.grid.size() * sizeof(uint32_t));
    std::vector<VkBufferCopy> regions;
    uint64_t source = 0;
    for (const voxel::NanoGrid::Range& range : change.gridRanges) {
        regions.push_back({source, range.offset, range.bytes});
        source += range.bytes;
    }
    addCopy(graph, staged, grid, std::move(regions));
    return grid;
}

graph::BufferId VoxelVolume::add(graph::Graph& graph, const Scene& scene, const Voxelization& how, ao::Volume& volume) {
    gpu::Device& device = graph.device();
    const bool grid = how.structure == ao::VolumeStructure::nanovdb, onGpu = how.voxelizer == Voxelizer::gpu && !grid;
    const auto differs = [&](auto Voxelization::* field) { return how.*field != m_how.*field; };
    if (!m_voxels || differs(&Voxelization::voxelizer) || differs(&Voxelization::structure) || differs(&Voxelization::shell) ||
        differs(&Voxelization::cells) || differs(&Voxelization::levels) || differs(&Voxelization::cellSize) ||
        differs(&Voxelization::cache) || scene.masked != m_masked) {
        m_voxels = std::make_unique<voxel::Voxels>(voxel::Options{.cells = how.cells,
            .levels = how.levels,
            .cellSize = double(how.cellSize),
            .masked = scene.masked,
            .shell = how.shell,
            .nano = grid,
            .bits = !onGpu,
            .cache = how.cache,
            .progress = how.building,
            .say = [&device](const std::string& line) { device.log(gpu::Severity::warning, line); }});
        m_bits = {};
        m_how = how;
        m_masked = scene.masked;
    }
    // After frames without voxels, the worker's last result is of long ago.
    using Wait = voxel::Voxels::Wait;
    const bool missed = device.frame() != m_frame + 1;
    m_frame = device.frame();
    const voxel::Change& change = m_voxels->update(scene.world, scene.time, scene.camera.eye,
        how.exact ? Wait::exact
        : missed  ? Wait::current
                  : Wait::latest);
    if (change.cells == 0) return {};
    volume.structure = how.structure;
    volume.cells = change.cells;
    volume.levels = change.levels;
    const glm::dmat4 worldFromEye = glm::inverse(glm::dmat4(scene.camera.view()));
    glm::mat4 cellFromEye(1.0f);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row)
            cellFromEye[column][row] =
                float(worldFromEye[column][row] / change.cellSize - (column == 3 ? double(change.origin[row]) - 0.5 : 0.0));
    for (int axis = 0; axis < 3; ++axis) volume.origin[axis] = change.origin[axis];
    std::memcpy(volume.cellFromEye, &cellFromEye, sizeof(volume.cellFromEye));
    if (grid) return uploadGrid(graph, change);
    if (onGpu) return m_raster.add(graph, scene.drawables, scene.posed, change, scene.masked, how.shell);
    return upload(graph, change);
}

}  // namespace obscura::render
