// Times, printed and not judged: machines differ and are shared. The targets are the project's own: the whole of Sponza to
// 256 cells in 60 ms on two cores, a frame of eight walking toasters in 4 ms of the worker.
#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "shapes.h"
#include "voxel/sparse.h"
#include "voxel/voxels.h"

namespace obscura::test {
namespace {

using Clock = std::chrono::steady_clock;
double since(Clock::time_point start) { return std::chrono::duration<double, std::milli>(Clock::now() - start).count(); }
double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + long(values.size() / 2), values.end());
    return values[values.size() / 2];
}

TEST(Measure, sponza) {
    const std::filesystem::path file = contentFolder() / "sponza/512/Sponza.gltf";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    scene::World world;
    world.add({.model = scene::loadGltf(file, {.loadImages = false})});
    voxel::Posed all;
    for (const scene::PosedPrimitive& posed : scene::pose(world, 0.0f)) {
        for (const uint32_t index : posed.primitive->indices) all.indices.push_back(index + uint32_t(all.positions.size()));
        all.positions.insert(all.positions.end(), posed.positions.begin(), posed.positions.end());
    }
    const scene::Bounds bounds = scene::bounds(world, 0.0f);
    const glm::vec3 size = bounds.max - bounds.min;
    for (const int cells : {64, 128, 256, 512}) {
        const double cellSize = double(std::max({size.x, size.y, size.z})) / cells;
        std::vector<double> rasterised, merged;
        uint64_t set = 0, bytes = 0;
        for (int i = 0; i < 7; ++i) {
            voxel::BrickSet bricks;
            Clock::time_point start = Clock::now();
            voxel::rasterise(all.triangles(), cellSize, bricks);
            rasterised.push_back(since(start));
            start = Clock::now();
            voxel::Sparse sparse;
            sparse.add(bricks);
            merged.push_back(since(start));
            set = sparse.cells();
            bytes = sparse.bytes();
        }
        fmt::print("Sponza, {} triangles, {} cells: {:.1f} ms rasterised, {:.1f} ms into OpenVDB, {} cells set, {:.2f} MiB of OpenVDB, {:.2f} MiB window\n",
                   all.indices.size() / 3, cells, median(rasterised), median(merged), set, double(bytes) / 1048576.0, double(cells) * cells * cells / 8 / 1048576.0);
    }
    Folder folder;
    for (const char* how : {"made", "from the cache"}) {
        voxel::Voxels voxels({.cells = 256, .cache = folder.path()});
        const Clock::time_point start = Clock::now();
        voxels.update(world, 0.0f, glm::vec3(0.0f), voxel::Voxels::Wait::exact);
        fmt::print("Sponza, {}: {:.1f} ms resting, {:.1f} ms to the first window\n", how, voxels.statistics().resting.milliseconds, since(start));
    }
}

TEST(Measure, eightWalkingToasters) {
    const std::filesystem::path hall = contentFolder() / "sponza/512/Sponza.gltf", toys = contentFolder() / "toasters/toasters_nodes.glb";
    if (!std::filesystem::exists(hall) || !std::filesystem::exists(toys)) GTEST_SKIP() << hall << " or " << toys << " is not there";
    scene::World world;
    world.add({.model = scene::loadGltf(hall, {.loadImages = false})});
    const auto toy = scene::loadGltf(toys, {.loadImages = false});
    std::vector<int> roots;
    for (const int node : toy->order)
        if (const std::string& name = toy->nodes[size_t(node)].name; name.starts_with("Toaster") && name.size() == 8) roots.push_back(node);
    ASSERT_FALSE(roots.empty());
    size_t triangles = 0;
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 at(0.8f * float(i) - 3.0f, 0.1f, 0.0f);
        world.add({.model = toy, .placement = glm::translate(glm::mat4(1.0f), at), .timeOffset = 0.7f * float(i), .root = roots[size_t(i) % roots.size()]});
        scene::World one;
        one.add(world.instances().back());
        triangles += one.triangleCount();
    }
    voxel::Voxels voxels({.cells = 256});
    std::vector<double> worker, bytes;
    for (int frame = 0; frame < 60; ++frame) {
        voxels.update(world, float(frame) / 30.0f, {0.05f * float(frame), 1.7f, 0.0f}, voxel::Voxels::Wait::exact);
        const voxel::Statistics facts = voxels.statistics();
        if (frame < 2) continue;
        worker.push_back(facts.workerMilliseconds);
        bytes.push_back(double(facts.changedBytes));
    }
    const voxel::Statistics facts = voxels.statistics();
    fmt::print("eight toasters, {} triangles in {} objects, {} cells: worker {:.2f} ms median, {:.2f} best, {:.2f} worst; {:.1f} KiB changed median\n", triangles,
               facts.objects, facts.objectCells, median(worker), *std::min_element(worker.begin(), worker.end()),
               *std::max_element(worker.begin(), worker.end()), median(bytes) / 1024.0);
}

TEST(Measure, tenMillionTriangles) {
    if (!std::getenv("OBSCURA_LONG_TESTS")) GTEST_SKIP() << "set OBSCURA_LONG_TESTS to run it: a gigabyte, half a minute";
    scene::World world;
    world.add({.model = modelOf(randomSoup(10000000, 15.0f, 0.05f))});
    voxel::Voxels voxels({.cells = 256});
    const Clock::time_point start = Clock::now();
    float last = -1.0f;
    size_t steps = 0;
    while (voxels.update(world, 0.0f, glm::vec3(0.0f), voxel::Voxels::Wait::latest).cells == 0) {
        const float progress = voxels.statistics().progress;
        if (progress < 1.0f && progress != last) ++steps, last = progress;
    }
    EXPECT_GE(steps, 5u);  // a bar has something to show
    const voxel::Statistics facts = voxels.statistics();
    fmt::print("{} triangles: {:.0f} ms, {} steps of progress, {} cells, {:.1f} MiB of OpenVDB, worst wait of the caller {:.2f} ms\n", facts.resting.triangles,
               since(start), steps, facts.resting.cells, double(facts.resting.bytes) / 1048576.0, facts.worstWait);
}

}  // namespace
}  // namespace obscura::test
