#include "render/voxel_raster.h"

#include <cmath>

#include "voxel/job.h"
#include "voxel/window.h"

namespace obscura::render {
namespace {

// A level's window.
struct Level {
    uint32_t level;
    double cellSize;    // metres, of level 0
    glm::ivec3 corner;  // lowest cell, of the level
    uint32_t cells;
};

// Rows of the matrix from object space to cells of the level from the window's lowest corner. Double precision until that is subtracted.
void rowsOf(const glm::mat4& world, const Level& where, shared::vec4 rows[3]) {
    const double shrink = std::exp2(-double(where.level));
    for (int r = 0; r < 3; ++r) {
        const auto cells = [&](int column) { return double(world[column][r]) / where.cellSize * shrink; };
        rows[r] = {float(cells(0)), float(cells(1)), float(cells(2)), float(cells(3) + 0.5 * shrink - double(where.corner[r]))};
    }
}

bool intersects(const scene::Bounds& box, const Level& where) {
    const double cell = where.cellSize * std::exp2(double(where.level));
    for (int k = 0; k < 3; ++k) {
        const double low = (double(where.corner[k]) - 1.0) * cell, high = low + (double(where.cells) + 1.0) * cell;
        if (double(box.max[k]) < low || double(box.min[k]) > high) return false;
    }
    return true;  // also for a box with NaN: some of its triangles can be finite
}

}  // namespace

gpu::Status VoxelRaster::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, VoxelRaster& out) {
    out.m_device = &device;
    return gpu::Program::compute(device, shaders, "voxel/rasterise.comp", {}, out.m_program);
}

bool VoxelRaster::bindable(const ModelGpu& model) {
    const uint64_t most = m_device->caps().maxStorageRange;
    if (model.vertices.bytes() <= most && model.indices.bytes() <= most) return true;
    if (m_logged != &model)
        m_device->log(gpu::Severity::warning,
            "voxels: " + model.model->name + " exceeds this device's maxStorageBufferRange and is skipped; use the voxelizer openvdb");
    m_logged = &model;
    return false;
}

graph::BufferId VoxelRaster::add(graph::Graph& graph, std::span<const Drawable> drawables, const Deform::Posed& posed,
    const voxel::Change& where, bool masked, voxel::Shell shell) {
    struct Draw {
        const ModelGpu* model;
        shared::VoxelJob job;
    };
    std::vector<Draw> draws;
    const uint32_t mask = where.cells - 1;
    for (uint32_t k = 0; k < where.levels; ++k) {
        const glm::ivec3 corner = voxel::windowOrigin(where.cells, k, where.centreBrick()) * voxel::kBrickSide;
        const Level level{k, where.cellSize, corner, where.cells};
        for (const Drawable& drawable : drawables) {
            const scene::AlphaMode mode = drawable.primitive->material->alphaMode;
            if (mode == scene::AlphaMode::blend || (mode == scene::AlphaMode::mask && !masked)) continue;
            if (!intersects(drawable.bounds, level) || !bindable(*drawable.model)) continue;
            const bool isPosed = drawable.posed != kNotPosed;
            shared::VoxelJob job{};
            rowsOf(drawable.world, level, job.rows);
            job.corner = {uint32_t(corner.x) & mask, uint32_t(corner.y) & mask, uint32_t(corner.z) & mask, where.cells};
            job.triangles = drawable.primitive->indexCount / 3;
            job.indices = uint32_t(drawable.primitive->indices / sizeof(uint32_t));
            job.positions = isPosed ? drawable.posed * 3 : uint32_t(drawable.primitive->positions / sizeof(float));
            job.posed = isPosed ? 1 : 0;
            job.thin = shell == voxel::Shell::thin ? 1 : 0;
            job.firstWord = uint32_t(where.bytes() / where.levels / sizeof(uint32_t)) * k;
            draws.push_back({drawable.model, job});
        }
    }
    const graph::BufferId bits = graph.buffer("voxels", where.bytes());
    graph.pass("voxels.clear").use(bits, graph::Access::transferWrite).record([bits](const graph::PassContext& c) {
        const graph::ExternalBuffer buffer = c.buffer(bits);
        c.device.vk().CmdFillBuffer(c.cmd, buffer.buffer, buffer.offset, buffer.bytes, 0);
    });
    const graph::BufferId positions = posed.now ? posed.now : graph.upload("nothing posed", glm::vec4(0.0f));
    graph.pass("voxels.rasterise", m_program)
        .read(positions)
        .write(bits)
        .record([this, draws = std::move(draws)](const graph::PassContext& c) {
            const ModelGpu* bound = nullptr;
            for (const Draw& draw : draws) {
                if (draw.model != bound) {
                    const VkDescriptorSet set =
                        m_sets.of(*m_device, c.program->setLayout(1), *draw.model, {&draw.model->vertices, &draw.model->indices});
                    if (set == VK_NULL_HANDLE) continue;
                    c.device.vk().CmdBindDescriptorSets(c.cmd, VK_PIPELINE_BIND_POINT_COMPUTE, c.program->layout(), 1, 1, &set, 0, nullptr);
                    bound = draw.model;
                }
                c.push(&draw.job, sizeof(draw.job));
                c.device.vk().CmdDispatch(c.cmd, (draw.job.triangles + c.program->workgroup()[0] - 1) / c.program->workgroup()[0], 1, 1);
            }
        });
    return bits;
}

}  // namespace obscura::render
