// voxel::Voxels: a copy maintained by its changes against a complete voxelization.
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <glm/gtc/matrix_transform.hpp>

#include "models.h"
#include "shapes.h"
#include "voxel/voxels.h"

namespace obscura::test {
namespace {

using voxel::Change;
using voxel::Voxels;

// The copy that the GPU would hold.
struct Copy {
    std::vector<voxel::Brick> bricks;
    glm::ivec3 origin{0};
    void apply(const Change& change) {
        if (change.cells == 0) return;
        bricks.resize(change.bytes() / sizeof(voxel::Brick));
        origin = change.origin;
        for (size_t i = 0; i < change.addresses.size(); ++i) bricks[change.addresses[i]] = change.bricks[i];
    }
    uint64_t cells() const {
        uint64_t sum = 0;
        for (const voxel::Brick& brick : bricks) sum += brick.count();
        return sum;
    }
};

voxel::Options small() { return {.cells = 64, .cellSize = 0.1}; }

Copy fromNothing(const scene::World& world, float time, const glm::vec3& eye) {
    Voxels voxels(small());
    Copy copy;
    copy.apply(voxels.update(world, time, eye, Voxels::Wait::exact));
    return copy;
}

void expectSame(const Copy& a, const Copy& b, int step) {
    ASSERT_EQ(a.origin, b.origin) << step;
    ASSERT_EQ(a.bricks.size(), b.bricks.size());
    for (size_t i = 0; i < a.bricks.size(); ++i) ASSERT_EQ(a.bricks[i], b.bricks[i]) << "step " << step << ", brick " << i;
}

scene::World busyWorld() {
    scene::World world;
    world.add(instanceOf(floorPlate()));
    world.add(instanceOf(turningCube(), {0.5f, 0.8f, 0.0f}));
    world.add(instanceOf(bendingBar(), {-1.5f, 0.2f, 0.5f}));
    world.add(instanceOf(wavingPatch(), {0.0f, 0.5f, -1.0f}));
    return world;
}

TEST(Voxels, changesAddUpToACompleteVoxelization) {
    scene::World world = busyWorld();
    Voxels voxels(small());
    Copy copy;
    uint32_t dropped = 0;
    uint64_t most = 0;
    for (int step = 0; step < 24; ++step) {
        const float time = 0.13f * float(step);
        if (step == 6) dropped = world.add(instanceOf(turningCube(), {-0.5f, 0.6f, 0.8f}));
        if (step == 9) world.instances().back().placement = glm::translate(glm::mat4(1.0f), {0.3f, 0.4f, 0.5f});
        if (step == 14) world.remove(dropped);
        if (step == 18)
            world.instances()[0].placement = glm::rotate(glm::mat4(1.0f), 0.2f, glm::vec3(1, 0, 0));  // the floor, static so far
        const glm::vec3 eye(3.0f * std::sin(0.7f * float(step)), 1.0f, 0.4f * float(step));
        copy.apply(voxels.update(world, time, eye, Voxels::Wait::exact));
        expectSame(copy, fromNothing(world, time, eye), step);
        most = std::max(most, copy.cells());
    }
    EXPECT_GT(most, 2000u);
}

TEST(Voxels, onlyMovedObjectsAreRevoxelized) {
    scene::World world = busyWorld();
    Voxels voxels(small());
    voxels.update(world, 0.5f, glm::vec3(0.0f), Voxels::Wait::exact);
    EXPECT_GT(voxels.statistics().redone, 0u);
    const Change& same = voxels.update(world, 0.5f, glm::vec3(0.0f), Voxels::Wait::exact);
    EXPECT_EQ(voxels.statistics().redone, 0u);
    EXPECT_TRUE(same.addresses.empty());
    const Change& later = voxels.update(world, 0.6f, glm::vec3(0.0f), Voxels::Wait::exact);
    EXPECT_GT(voxels.statistics().redone, 0u);
    EXPECT_FALSE(later.addresses.empty());
    EXPECT_LT(later.bricks.size() * 64, voxels.statistics().windowBytes / 4);
}

// Without waiting, update() returns the world of the previous call.
TEST(Voxels, latestIsOneFrameBehind) {
    const scene::World world = busyWorld();
    Voxels voxels(small());
    Copy copy;
    copy.apply(voxels.update(world, 1.5f, glm::vec3(0.0f), Voxels::Wait::exact));  // geometry at rest is built
    copy.apply(voxels.update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::latest));
    expectSame(copy, fromNothing(world, 1.5f, glm::vec3(0.0f)), 0);
    for (int step = 1; step < 8; ++step) {
        uint64_t late = voxels.statistics().late;
        do {  // on a loaded machine the worker may be late; then nothing has changed
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            late = voxels.statistics().late;
            copy.apply(voxels.update(world, 0.2f * float(step), glm::vec3(0.0f), Voxels::Wait::latest));
        } while (voxels.statistics().late != late);
        expectSame(copy, fromNothing(world, 0.2f * float(step - 1), glm::vec3(0.0f)), step);
    }
}

// A named pipe in place of a cache file. A reader waits until unblock(), or for one minute, so that an error fails the test instead of
// hanging.
class BlockedFile {
public:
    BlockedFile(std::filesystem::path file, std::string bytes) : m_file(std::move(file)), m_bytes(std::move(bytes)) {
        std::filesystem::remove(m_file);
        EXPECT_EQ(::mkfifo(m_file.c_str(), 0600), 0);
        m_thread = std::thread([this] { serve(); });
    }
    ~BlockedFile() {
        unblock();
        m_thread.join();
    }
    void unblock() { m_unblocked.store(true); }

private:
    void serve() {
        std::signal(SIGPIPE, SIG_IGN);
        for (int i = 0; i < 6000 && !m_unblocked; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        int pipe = -1;
        for (int i = 0; i < 6000 && pipe < 0; ++i) {  // fails until a reader opens the pipe
            pipe = ::open(m_file.c_str(), O_WRONLY | O_NONBLOCK);
            if (pipe < 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        if (pipe < 0) return;
        ::fcntl(pipe, F_SETFL, 0);
        for (size_t at = 0; at < m_bytes.size();) {
            const ssize_t count = ::write(pipe, m_bytes.data() + at, m_bytes.size() - at);
            if (count <= 0) break;
            at += size_t(count);
        }
        ::close(pipe);
    }
    const std::filesystem::path m_file;
    const std::string m_bytes;
    std::atomic<bool> m_unblocked{false};
    std::thread m_thread;
};

// While geometry at rest is being built (its thread is blocked reading the cache file), no call waits for it, and objects keep moving. The
// game prints the waiting time of its calls when it ends.
TEST(Voxels, objectsMoveDuringABuild) {
    TemporaryFolder folder;
    scene::World world;
    world.add({.model = modelOf(randomSoup(70000, 3.0f, 0.1f))});
    voxel::Options options = small();
    options.cache = folder.path();
    Voxels(options).update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::exact);
    const std::filesystem::path file = folder.files().at(0);
    std::ostringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();

    scene::World moving;
    moving.add(instanceOf(turningCube(), {0.5f, 0.8f, 0.0f}));
    world.add(moving.instances()[0]);
    BlockedFile blocked(file, bytes.str());
    Voxels voxels(options);
    Copy copy;
    for (int step = 0; step < 12; ++step) {
        const float time = 0.2f * float(step);
        copy.apply(voxels.update(world, time, glm::vec3(0.0f), Voxels::Wait::current));
        expectSame(copy, fromNothing(moving, time, glm::vec3(0.0f)), step);
        EXPECT_LT(voxels.statistics().progress, 1.0f);
    }
    EXPECT_EQ(voxels.statistics().resting.fromCache, 0u);
    blocked.unblock();
    const Copy whole = fromNothing(world, 3.0f, glm::vec3(0.0f));
    while (voxels.statistics().resting.cells == 0) {
        copy.apply(voxels.update(world, 3.0f, glm::vec3(0.0f), Voxels::Wait::latest));
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    copy.apply(voxels.update(world, 3.0f, glm::vec3(0.0f), Voxels::Wait::exact));
    EXPECT_EQ(voxels.statistics().resting.fromCache, 1u);
    expectSame(copy, whole, 12);
}

// ---- The windows follow the camera alone ---------------------------------------------------------------------------------

uint64_t cellsAround(Voxels& voxels, Copy& copy, const scene::World& world, float time, const glm::vec3& eye) {
    copy.apply(voxels.update(world, time, eye, Voxels::Wait::exact));
    return copy.cells();
}

// Nothing is at rest, and the only object has moved far from where it was first.
TEST(Voxels, cubeThatMovedAwayIsFollowed) {
    scene::World world;
    world.add(instanceOf(turningCube()));
    Voxels voxels(small());
    Copy copy;
    EXPECT_GT(cellsAround(voxels, copy, world, 0.0f, glm::vec3(0, 1, 2)), 300u);
    world.instances()[0].placement = glm::translate(glm::mat4(1.0f), {200.0f, 30.0f, -100.0f});
    EXPECT_GT(cellsAround(voxels, copy, world, 0.0f, glm::vec3(200, 31, -98)), 300u);
    EXPECT_EQ(cellsAround(voxels, copy, world, 0.0f, glm::vec3(0, 1, 2)), 0u);
}

// Two animated boxes high above a floor that is much wider than high.
TEST(Voxels, boxesHighAboveAFloorAreSeen) {
    scene::World world;
    Soup floor;
    floor.add({-100, 0, -100}, {100, 0, -100}, {0, 0, 100});
    world.add({.model = modelOf(floor)});
    world.add(instanceOf(turningCube(), {0.0f, 60.0f, 0.0f}));
    world.add(instanceOf(turningCube(), {1.5f, 61.0f, 0.0f}));
    Voxels voxels(small());
    Copy copy;
    const uint64_t before = cellsAround(voxels, copy, world, 0.0f, glm::vec3(0, 60, 2));
    EXPECT_GT(before, 600u);
    EXPECT_NE(cellsAround(voxels, copy, world, 0.4f, glm::vec3(0, 60, 2)), before);
}

// An object outside of all windows costs nothing, and comes back when the camera does.
TEST(Voxels, objectsOutsideAreNotRasterised) {
    scene::World world;
    world.add(instanceOf(turningCube()));
    world.add(instanceOf(bendingBar(), {0.0f, 0.0f, 2.0f}));
    world.add(instanceOf(wavingPatch(), {2.0f, 0.0f, 0.0f}));
    Voxels voxels(small());
    for (int step = 0; step < 8; ++step) {
        const bool far = step % 4 > 1;
        const float time = 0.1f * float(step);
        voxels.update(world, time, far ? glm::vec3(500, 0, 0) : glm::vec3(0), Voxels::Wait::exact);
        EXPECT_EQ(voxels.statistics().objects, 3u);
        // Those that left are cleared once.
        if (step % 4 == 3) EXPECT_EQ(voxels.statistics().redone, 0u);
        else EXPECT_EQ(voxels.statistics().redone, 3u);
        EXPECT_EQ(voxels.statistics().objectCells == 0, far);
    }
}

// Removing an instance at rest beside a large one: the large one is not rasterised again, and objects do not wait.
TEST(Voxels, removalLeavesTheNeighbourAlone) {
    scene::World world;
    world.add({.model = modelOf(randomSoup(300000, 3.0f, 0.1f))});
    const uint32_t plate = world.add(instanceOf(floorPlate()));
    world.add(instanceOf(turningCube(), {0.0f, 2.0f, 0.0f}));
    Voxels voxels(small());
    Copy copy;
    copy.apply(voxels.update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::exact));
    EXPECT_EQ(voxels.statistics().resting.rasterised, 2u);
    world.remove(plate);
    copy.apply(voxels.update(world, 0.1f, glm::vec3(0.0f), Voxels::Wait::current));
    EXPECT_EQ(voxels.statistics().resting.rasterised, 2u);
    EXPECT_EQ(voxels.statistics().progress, 1.0f);
    expectSame(copy, fromNothing(world, 0.1f, glm::vec3(0.0f)), 0);
}

// After a pause in which the camera flew and the object moved, the first update is of its own frame.
TEST(Voxels, firstUpdateAfterAPauseIsOfItsFrame) {
    scene::World world = busyWorld();
    Voxels voxels(small());
    Copy copy;
    for (int i = 0; i < 5; ++i) copy.apply(voxels.update(world, 0.0f, glm::vec3(-20, 0, 0), Voxels::Wait::exact));
    copy.apply(voxels.update(world, 0.0f, glm::vec3(-20, 0, 0), Voxels::Wait::latest));
    copy.apply(voxels.update(world, 2.0f, glm::vec3(0.5f, 0, 0), Voxels::Wait::current));
    expectSame(copy, fromNothing(world, 2.0f, glm::vec3(0.5f, 0, 0)), 0);
}

TEST(Voxels, resendReturnsEverything) {
    const scene::World world = busyWorld();
    Voxels voxels(small());
    Copy first, second;
    first.apply(voxels.update(world, 0.5f, glm::vec3(0.0f), Voxels::Wait::exact));
    voxels.resend();
    second.apply(voxels.update(world, 0.5f, glm::vec3(0.0f), Voxels::Wait::exact));
    expectSame(first, second, 0);
}

TEST(Voxels, tooLargeInstanceIsReportedOnce) {
    scene::World world;
    Soup wide;
    wide.add({-5e5f, 0, -5e5f}, {5e5f, 0, -5e5f}, {0, 0, 5e5f});
    const uint32_t id = world.add({.model = modelOf(wide)});
    std::vector<std::string> lines;
    Voxels voxels({.cells = 64, .cellSize = 0.1, .say = [&](const std::string& line) { lines.push_back(line); }});
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(voxels.update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::exact).bricks.empty());
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("use cells of"), std::string::npos);
    world.remove(id);
    world.add(instanceOf(floorPlate()));
    EXPECT_FALSE(voxels.update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::exact).bricks.empty());
}

TEST(Voxels, emptyWorldIsAnEmptyWindow) {
    Voxels voxels({.cells = 64});
    const Change& change = voxels.update({}, 0.0f, glm::vec3(0.0f), Voxels::Wait::exact);
    EXPECT_EQ(change.cells, 64u);
    EXPECT_TRUE(change.addresses.empty());
}

TEST(Voxels, maskedMaterialsAreOptional) {
    scene::Material masked;
    masked.alphaMode = scene::AlphaMode::mask;
    scene::World world;
    world.add(instanceOf(with(floorPlate(), masked)));
    Copy with, without;
    Voxels taking({.cells = 64}), leaving({.cells = 64, .masked = false});
    with.apply(taking.update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::exact));
    without.apply(leaving.update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::exact));
    EXPECT_GT(with.cells(), 1000u);
    EXPECT_EQ(without.cells(), 0u);
}

}  // namespace
}  // namespace obscura::test
