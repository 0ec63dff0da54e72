// GPU voxelization against OpenVDB, cell by cell. The GPU works in single precision with a tolerance: no cell may be missing, and
// few may be extra.
#include <bit>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "gpu/test_device.h"
#include "graph/executor.h"
#include "models.h"
#include "render/renderer.h"
#include "voxel/shapes.h"

namespace obscura::test {
namespace {

class VoxelRasterTest : public GpuTest {
protected:
    void SetUp() override {
        GpuTest::SetUp();
        m_shaders.add(render::shaders());
        m_shaders.add(ao::shaders());
        m_renderer = render::Renderer::create(device(), m_shaders);
        m_graph = std::make_unique<graph::Graph>(device());
        m_executor = std::make_unique<graph::Executor>(device());
    }
    void TearDown() override {
        m_graph.reset();
        m_executor.reset();
        m_renderer.reset();
        GpuTest::TearDown();
    }

    std::vector<uint32_t> bits(
        const scene::World& world, float time, const render::Voxelization& how, const glm::vec3& eye = {0.1f, 0.9f, 3.0f}) {
        const ao::Values values(*ao::findMethod("hybrid"));
        render::FrameOptions options;
        options.visible = {32, 24};
        options.guard = 0.0f;
        options.method = &values;
        options.camera.eye = eye;
        options.camera.target = {0.0f, 0.1f, 0.0f};
        options.time = time;
        options.voxels = how;
        device().nextFrame();
        m_graph->begin();
        const render::Outputs out = m_renderer->add(*m_graph, world, options);
        EXPECT_TRUE(bool(out.voxels));
        if (!out.voxels) return {};
        std::vector<uint32_t> result(size_t(how.levels) * how.cells * how.cells * how.cells / 32);
        gpu::Buffer back;
        EXPECT_EQ(gpu::Buffer::create(device(), result.size() * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback, "back", back),
            gpu::Status::ok);
        const graph::BufferId to = m_graph->import("back", back, graph::Graph::Shared::written);
        m_graph->pass("read back")
            .use(out.voxels, graph::Access::transferRead)
            .use(to, graph::Access::transferWrite)
            .keep()
            .record([from = out.voxels, handle = back.handle()](const graph::PassContext& c) {
                const graph::ExternalBuffer source = c.buffer(from);
                const VkBufferCopy copy{source.offset, 0, source.bytes};
                c.device.vk().CmdCopyBuffer(c.cmd, source.buffer, handle, 1, &copy);
            });
        EXPECT_EQ(
            device().runNow([&](VkCommandBuffer cmd) { EXPECT_EQ(m_executor->execute(*m_graph, cmd), gpu::Status::ok); }), gpu::Status::ok);
        std::memcpy(result.data(), back.mapped(), result.size() * 4);
        return result;
    }

    struct Difference {
        size_t set = 0, missing = 0, extra = 0;
    };
    Difference compare(const scene::World& world, float time, render::Voxelization how, const glm::vec3& eye = {0.1f, 0.9f, 3.0f}) {
        how.voxelizer = render::Voxelizer::openvdb;
        const std::vector<uint32_t> expected = bits(world, time, how, eye);
        how.voxelizer = render::Voxelizer::gpu;
        const std::vector<uint32_t> got = bits(world, time, how, eye);
        Difference d;
        for (size_t i = 0; i < got.size() && i < expected.size(); ++i) {
            d.set += size_t(std::popcount(expected[i]));
            d.missing += size_t(std::popcount(expected[i] & ~got[i]));
            d.extra += size_t(std::popcount(got[i] & ~expected[i]));
        }
        fmt::print("{} levels of {} cells a side{}: {} set, {} missing, {} extra\n", how.levels, how.cells,
            how.shell == voxel::Shell::thin ? ", thin" : "", d.set, d.missing, d.extra);
        return d;
    }

    gpu::ShaderLibrary m_shaders;
    std::unique_ptr<render::Renderer> m_renderer;
    std::unique_ptr<graph::Graph> m_graph;
    std::unique_ptr<graph::Executor> m_executor;
};

scene::World worldOf(std::shared_ptr<const scene::Model> model, const glm::vec3& at = glm::vec3(0.0f)) {
    scene::World world;
    world.add(instanceOf(std::move(model), at));
    return world;
}

// Thin shells of coarse levels are those of the triangles on the GPU, and unions of fine cells on the CPU.
uint32_t levelsOf(voxel::Shell shell) { return shell == voxel::Shell::thin ? 1 : 5; }

TEST_F(VoxelRasterTest, randomTrianglesSmallAndLarge) {
    for (const voxel::Shell shell : {voxel::Shell::conservative, voxel::Shell::thin})
        for (const uint32_t cells : {64u, 256u}) {
            Soup soup = randomSoup(4000, 4.0f, 0.3f, 7);
            const Soup large = randomSoup(200, 4.0f, 9.0f, 8);
            for (size_t i = 0; i < large.positions.size(); i += 3)
                soup.add(large.positions[i], large.positions[i + 1], large.positions[i + 2]);
            const Difference d = compare(worldOf(modelOf(soup)), 0.0f, {.shell = shell, .cells = cells, .levels = levelsOf(shell)});
            EXPECT_GT(d.set, 10000u);
            // Thin shells depend on a triangle's dominant axis, which rounding decides where two are equal.
            EXPECT_LE(d.missing, shell == voxel::Shell::thin ? d.set / 5000 : 0);
            EXPECT_LT(d.extra, d.set / 500);
        }
}

TEST_F(VoxelRasterTest, animatedMeshesUseTheirPose) {
    scene::World world = worldOf(floorPlate());
    world.add(instanceOf(turningCube(), {0.5f, 0.4f, 0.0f}));
    world.add(instanceOf(bendingBar(), {-0.7f, 0.2f, 0.3f}));
    world.add(instanceOf(wavingPatch(), {0.0f, 1.0f, -0.5f}));
    for (const float time : {0.0f, 0.37f, 0.9f}) {
        const Difference d = compare(world, time, {.cells = 256, .cellSize = 0.02f});
        EXPECT_GT(d.set, 10000u);
        // CPU and GPU sum skin weights in another order: vertices differ by a few micrometres.
        EXPECT_LE(d.missing, d.set / 10000);
        EXPECT_LT(d.extra, d.set / 200);
    }
    EXPECT_NE(bits(world, 0.0f, {.voxelizer = render::Voxelizer::gpu}), bits(world, 0.37f, {.voxelizer = render::Voxelizer::gpu}));
}

TEST_F(VoxelRasterTest, windowInALargerWorld) {
    const scene::World world = worldOf(modelOf(randomSoup(3000, 12.0f, 4.0f, 9)));
    for (const float x : {-11.0f, 0.0f, 7.3f}) {
        const Difference d = compare(world, 0.0f, {.cells = 64, .cellSize = 0.1f}, {x, 1.0f, -0.5f * x});
        EXPECT_GT(d.set, 1000u);
        EXPECT_EQ(d.missing, 0u);
        EXPECT_LT(d.extra, d.set / 200);
    }
}

TEST_F(VoxelRasterTest, degenerateTrianglesAreHarmless) {
    Soup soup = randomSoup(50, 2.0f, 1.0f, 3);
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    soup.add({nan, 0, 0}, {1, 0, 0}, {0, 1, 0});
    soup.add({0, 0, 0}, {infinite, 0, 0}, {0, 1, 0});
    soup.add({0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f});  // a point
    soup.add({-1, -1, -1}, {1, 1.3f, 0.9f}, {0, 0.15f, -0.05f});           // a line
    const Difference d = compare(worldOf(modelOf(soup)), 0.0f, {.cells = 128, .cellSize = 0.05f});
    EXPECT_EQ(d.missing, 0u);
    EXPECT_LE(d.extra, d.set / 200);
}

TEST_F(VoxelRasterTest, sponza) {
    const std::filesystem::path file = contentFolder() / "sponza/512/Sponza.gltf";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is missing";
    const scene::World world = worldOf(scene::loadGltf(file, {.loadImages = false}));
    for (const voxel::Shell shell : {voxel::Shell::conservative, voxel::Shell::thin}) {
        const Difference d = compare(world, 0.0f, {.shell = shell, .levels = levelsOf(shell)});
        EXPECT_GT(d.set, 50000u);
        EXPECT_EQ(d.missing, 0u);
        EXPECT_LT(d.extra, d.set / 200);
    }
}

}  // namespace
}  // namespace obscura::test
