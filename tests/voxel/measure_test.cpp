// The work of voxelization, counted: cells, bytes, revoxelized objects, progress steps. The game prints the times when it ends:
// obscura --headless --scene sponza --toys 8 --method hybrid --frames 60
#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "shapes.h"
#include "voxel/sparse.h"
#include "voxel/voxels.h"

namespace obscura::test {
namespace {

// Halving the cell size gives four times as many cells on a surface, up to eight with many small triangles. Bytes follow the number of
// cells, not the volume of the window.
TEST(VoxelWork, scalesWithTheSurfaceOfSponza) {
    const std::filesystem::path file = contentFolder() / "sponza/512/Sponza.gltf";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is missing";
    scene::World world;
    world.add({.model = scene::loadGltf(file, {.loadImages = false})});
    voxel::Posed all;
    for (const scene::PosedPrimitive& posed : scene::pose(world, 0.0f)) {
        for (const uint32_t index : posed.primitive->indices) all.indices.push_back(index + uint32_t(all.positions.size()));
        all.positions.insert(all.positions.end(), posed.positions.begin(), posed.positions.end());
    }
    const scene::Bounds bounds = scene::bounds(world, 0.0f);
    const glm::vec3 size = bounds.max - bounds.min;
    uint64_t before = 0;
    for (const int cells : {64, 128, 256, 512}) {
        voxel::BrickSet bricks;
        voxel::rasterise(all.triangles(), double(std::max({size.x, size.y, size.z})) / cells, bricks);
        voxel::Sparse sparse;
        sparse.add(bricks);
        const uint64_t set = sparse.cells(), bytes = sparse.bytes();
        fmt::print("Sponza, {} cells: {} set, {:.2f} MiB of OpenVDB\n", cells, set, double(bytes) / 1048576.0);
        if (before > 0) {
            EXPECT_GT(set, 7 * before / 2) << cells;
            EXPECT_LT(set, 11 * before / 2) << cells;
        }
        EXPECT_LT(bytes, (3u << 20) + 2 * set) << cells;
        before = set;
    }
}

TEST(VoxelWork, sponzaIsRasterisedOnce) {
    const std::filesystem::path file = contentFolder() / "sponza/512/Sponza.gltf";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is missing";
    scene::World world;
    world.add({.model = scene::loadGltf(file, {.loadImages = false})});
    TemporaryFolder folder;
    size_t cells[2] = {};
    for (const bool again : {false, true}) {
        voxel::Voxels voxels({.cells = 256, .cache = folder.path()});
        voxels.update(world, 0.0f, glm::vec3(0.0f), voxel::Voxels::Wait::exact);
        EXPECT_EQ(voxels.statistics().resting.fromCache, again ? 1u : 0u);
        cells[again] = voxels.statistics().resting.cells;
    }
    EXPECT_GT(cells[0], 100000u);
    EXPECT_EQ(cells[1], cells[0]);
}

// In a hall with eight walking toasters a frame revoxelizes only the toasters and sends the changed bricks, a small part of the window.
TEST(VoxelWork, walkingToastersDoNotRevoxelizeTheHall) {
    const std::filesystem::path hall = contentFolder() / "sponza/512/Sponza.gltf", toys = contentFolder() / "toasters/toasters_nodes.glb";
    if (!std::filesystem::exists(hall) || !std::filesystem::exists(toys)) GTEST_SKIP() << hall << " or " << toys << " is missing";
    scene::World world;
    world.add({.model = scene::loadGltf(hall, {.loadImages = false})});
    const auto toy = scene::loadGltf(toys, {.loadImages = false});
    std::vector<int> roots;
    for (const int node : toy->order)
        if (const std::string& name = toy->nodes[size_t(node)].name; name.starts_with("Toaster") && name.size() == 8) roots.push_back(node);
    ASSERT_FALSE(roots.empty());
    for (int i = 0; i < 8; ++i) {
        const glm::mat4 placement = glm::translate(glm::mat4(1.0f), glm::vec3(0.8f * float(i) - 3.0f, 0.1f, 0.0f));
        world.add({.model = toy, .placement = placement, .timeOffset = 0.7f * float(i), .root = roots[size_t(i) % roots.size()]});
    }
    voxel::Voxels voxels({.cells = 256});
    std::vector<uint64_t> bytes;
    voxel::Statistics first;
    for (int frame = 0; frame < 60; ++frame) {
        voxels.update(world, float(frame) / 30.0f, {0.05f * float(frame), 1.7f, 0.0f}, voxel::Voxels::Wait::exact);
        const voxel::Statistics now = voxels.statistics();
        if (frame == 1) first = now;
        if (frame < 2) continue;
        bytes.push_back(now.changedBytes);
        EXPECT_EQ(now.resting.cells, first.resting.cells) << frame;
        EXPECT_EQ(now.resting.triangles, first.resting.triangles) << frame;
        EXPECT_EQ(now.objects, first.objects) << frame;
        EXPECT_LE(now.redone, now.objects) << frame;
        EXPECT_GT(now.redone, 0u) << frame;
        EXPECT_LT(now.objectCells, now.resting.cells / 10) << frame;
    }
    std::nth_element(bytes.begin(), bytes.begin() + long(bytes.size() / 2), bytes.end());
    fmt::print("eight toasters in {} objects of {} cells: {:.1f} KiB changed per frame (median)\n", first.objects, first.objectCells,
        double(bytes[bytes.size() / 2]) / 1024.0);
    EXPECT_LT(bytes[bytes.size() / 2], first.windowBytes / 100);
}

TEST(VoxelWork, progressIsReportedInSteps) {
    Soup soup = randomSoup(200000, 5.0f, 0.05f);
    const std::vector<uint32_t> once = soup.indices;
    for (int i = 0; i < 10; ++i) soup.indices.insert(soup.indices.end(), once.begin(), once.end());  // 2.2 million triangles
    std::vector<float> steps;
    voxel::RasterOptions options;
    options.progress = [&](float part) { steps.push_back(part); };
    voxel::BrickSet bricks;
    voxel::rasterise(soup.triangles(), 0.05, bricks, options);
    ASSERT_GE(steps.size(), 4u);
    EXPECT_EQ(steps.front(), 0.0f);
    EXPECT_TRUE(std::is_sorted(steps.begin(), steps.end()));
    EXPECT_EQ(steps.back(), 1.0f);
    for (size_t i = 1; i < steps.size(); ++i) EXPECT_LE(steps[i] - steps[i - 1], 0.5f);
}

TEST(VoxelWork, tenMillionTriangles) {
    if (!std::getenv("OBSCURA_LONG_TESTS")) GTEST_SKIP() << "set OBSCURA_LONG_TESTS to run it: needs 1 GB and 30 s";
    scene::World world;
    world.add({.model = modelOf(randomSoup(10000000, 15.0f, 0.05f))});
    voxel::Voxels voxels({.cells = 256});
    EXPECT_EQ(voxels.update(world, 0.0f, glm::vec3(0.0f), voxel::Voxels::Wait::exact).cells, 256u);
    const voxel::Statistics facts = voxels.statistics();
    EXPECT_EQ(facts.resting.triangles, 10000000u);
    EXPECT_GT(facts.resting.cells, 1000000u);
    EXPECT_LT(facts.resting.bytes, (64u << 20) + 2 * facts.resting.cells);
}

}  // namespace
}  // namespace obscura::test
