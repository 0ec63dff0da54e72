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

}  // namespace

graph::BufferId VoxelVolume::upload(graph::Graph& graph, const voxel::Change& change) {
    const uint64_t bytes = uint64_t(change.cells) * change.cells * change.cells / 8;
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
    graph.pass("voxels.upload")
        .use(staged, graph::Access::transferRead)
        .use(bits, graph::Access::transferWrite)
        .record([staged, bits, regions = std::move(regions)](const graph::PassContext& c) mutable {
            const graph::ExternalBuffer from = c.buffer(staged), to = c.buffer(bits);
            for (VkBufferCopy& region : regions) region.srcOffset += from.offset;
            c.device.vk().CmdCopyBuffer(c.cmd, from.buffer, to.buffer, uint32_t(regions.size()), regions.data());
        });
    return bits;
}

// Uploads the whole grid: adding or removing a leaf moves other nodes.
graph::BufferId VoxelVolume::uploadGrid(graph::Graph& graph, const voxel::Change& change) {
    const uint64_t bytes = change.grid.size() * sizeof(uint32_t);
    if (bytes > m_bits.bytes()) {
        const uint64_t most = graph.device().caps().maxStorageRange, withSpare = std::min(most, bytes + bytes / 4);
        m_bits = {};
        if (bytes > most) {
            graph.device().log(
                gpu::Severity::warning, "voxels: the NanoVDB grid exceeds this device's maxStorageBufferRange; use larger cells");
            return {};
        }
        if (gpu::Buffer::create(graph.device(), withSpare, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                gpu::Memory::device, "voxel grid", m_bits) != gpu::Status::ok)
            return {};
    }
    if (!m_bits) return {};
    const graph::BufferId grid = graph.import("voxel grid", m_bits, graph::Graph::Shared::written);
    if (bytes == 0) return grid;
    const graph::BufferId staged = graph.upload("new voxel grid", change.grid.data(), bytes);
    graph.pass("voxels.upload")
        .use(staged, graph::Access::transferRead)
        .use(grid, graph::Access::transferWrite)
        .record([staged, grid, bytes](const graph::PassContext& c) {
            const graph::ExternalBuffer from = c.buffer(staged), to = c.buffer(grid);
            const VkBufferCopy copy{from.offset, 0, bytes};
            c.device.vk().CmdCopyBuffer(c.cmd, from.buffer, to.buffer, 1, &copy);
        });
    return grid;
}

graph::BufferId VoxelVolume::add(graph::Graph& graph, const Scene& scene, const Voxelization& how, ao::Volume& volume) {
    gpu::Device& device = graph.device();
    const bool grid = how.structure == ao::VolumeStructure::nanovdb, onGpu = how.voxelizer == Voxelizer::gpu && !grid;
    const auto differs = [&](auto Voxelization::* field) { return how.*field != m_how.*field; };
    if (!m_voxels || differs(&Voxelization::voxelizer) || differs(&Voxelization::structure) || differs(&Voxelization::shell) ||
        differs(&Voxelization::cells) || differs(&Voxelization::cellSize) || differs(&Voxelization::cache) || scene.masked != m_masked) {
        m_voxels = std::make_unique<voxel::Voxels>(voxel::Options{.cells = how.cells,
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
    const voxel::Change& change =
        m_voxels->update(scene.world, scene.time, scene.camera.eye, how.exact ? voxel::Voxels::Wait::exact : voxel::Voxels::Wait::latest);
    if (change.cells == 0) return {};
    volume.structure = how.structure;
    volume.cells = change.cells;
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
