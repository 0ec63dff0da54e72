// The work of voxelization, counted: cells, bytes, revoxelized objects, progress steps. The game prints the times when it ends:
// obscura --headless --scene sponza --toys 8 --method hybrid --frames 60
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

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

// A world of 1 km with 10^7 triangles in 1,000 instances, flown through at 30 m/s while it is built and after: what moves keeps moving, and
// the copy on the GPU gets less than a tenth of its size in any frame but those that fill it.
TEST(VoxelWork, aKilometreOfInstances) {
    if (!std::getenv("OBSCURA_LONG_TESTS")) GTEST_SKIP() << "set OBSCURA_LONG_TESTS to run it: needs 3 GB and 2 minutes";
    std::vector<std::shared_ptr<scene::Model>> models;
    for (unsigned i = 0; i < 10; ++i) {  // hills of 28 m
        Soup hill;
        const auto at = [&](int x, int z) {
            const glm::vec2 p(0.4f * float(x) - 14.0f, 0.4f * float(z) - 14.0f);
            return glm::vec3(p.x, std::sin(0.5f * p.x + float(i)) * std::cos(0.7f * p.y), p.y);
        };
        for (int x = 0; x < 71; ++x)
            for (int z = 0; z < 71 && hill.indices.size() < 30000; ++z) {
                hill.add(at(x, z), at(x + 1, z), at(x, z + 1));
                if (hill.indices.size() < 30000) hill.add(at(x + 1, z), at(x + 1, z + 1), at(x, z + 1));
            }
        models.push_back(modelOf(hill));
    }
    scene::World world;
    for (int i = 0; i < 1000; ++i) {
        const glm::vec3 at(float(i % 32) * 31.0f - 500.0f, 0.0f, float(i / 32) * 31.0f - 500.0f);
        world.add({.model = models[size_t(i) % 10], .placement = glm::translate(glm::mat4(1.0f), at)});
    }
    std::vector<size_t> moving;
    const auto toy = modelOf(randomSoup(2000, 0.5f, 0.2f, 99));
    for (int i = 0; i < 4; ++i) {
        moving.push_back(world.instances().size());
        world.add({.model = toy});
    }
    std::vector<double> waits, worker;
    std::vector<uint64_t> bytes;
    uint64_t movedWhileBuilding = 0, buildFrames = 0, waitedLong = 0;
    double worstBuilding = 0.0;
    voxel::Voxels voxels({.cells = 256, .say = [](const std::string& line) { fmt::print("{}\n", line); }});
    double built = 0.0;
    const auto begun = std::chrono::steady_clock::now();
    for (int frame = 0; frame < 3000 && waits.size() < 300; ++frame) {
        const glm::vec3 eye(float(frame % 600) - 300.0f, 1.7f, 0.5f * float(frame % 600) - 150.0f);
        for (size_t i = 0; i < moving.size(); ++i)
            world.instances()[moving[i]].placement =
                glm::translate(glm::mat4(1.0f), eye + glm::vec3(2.0f, std::sin(0.3f * float(frame)), float(i)));
        const uint64_t late = voxels.statistics().late;
        voxels.update(world, float(frame) / 30.0f, eye, voxel::Voxels::Wait::latest);
        const voxel::Statistics now = voxels.statistics();
        if (now.progress < 1.0f || now.resting.bytes == 0) {
            ++buildFrames;
            worstBuilding = std::max(worstBuilding, now.waitMilliseconds);
            waitedLong += now.waitMilliseconds > 1.0;
            movedWhileBuilding += now.late == late && now.redone >= moving.size();
        } else {
            if (waits.empty()) built = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
            waits.push_back(now.waitMilliseconds);
            worker.push_back(now.workerMilliseconds);
            bytes.push_back(now.changedBytes);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ASSERT_EQ(waits.size(), 300u);
    const voxel::Statistics facts = voxels.statistics();
    const auto middle = [](auto list) {
        std::nth_element(list.begin(), list.begin() + long(list.size() / 2), list.end());
        return list[list.size() / 2];
    };
    fmt::print("{} triangles, {} cells in {} bricks of {:.3g} m: {:.0f} MiB; built in {:.1f} s, {} frames, objects moved in {} of them\n",
        facts.resting.triangles, facts.resting.cells, facts.resting.bricks,
        voxels.update(world, 0.0f, glm::vec3(0), voxel::Voxels::Wait::current).cellSize, double(facts.resting.bytes) / 1048576.0, built,
        buildFrames, movedWhileBuilding);
    fmt::print("while it was built: the caller waited more than 1 ms in {} frames, at most {:.2f} ms\n", waitedLong, worstBuilding);
    fmt::print("a frame: worker {:.2f} ms (worst {:.1f}), caller waits {:.2f} ms (worst {:.2f}), {:.0f} KiB (most {:.0f}) of {:.0f}\n",
        middle(worker), *std::max_element(worker.begin(), worker.end()), middle(waits), facts.worstWait, double(middle(bytes)) / 1024.0,
        double(*std::max_element(bytes.begin(), bytes.end())) / 1024.0, double(facts.windowBytes) / 1024.0);
    EXPECT_EQ(facts.resting.triangles, 10000000u);
    EXPECT_GT(movedWhileBuilding, buildFrames / 2);
    EXPECT_LT(*std::max_element(bytes.begin(), bytes.end()), facts.windowBytes / 10);
}

}  // namespace
}  // namespace obscura::test
