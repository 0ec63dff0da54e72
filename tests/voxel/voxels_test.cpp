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
        bricks.resize(size_t(change.cells / 8) * (change.cells / 8) * (change.cells / 8));
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
    for (int step = 0; step < 24; ++step) {
        const float time = 0.13f * float(step);
        if (step == 6) dropped = world.add(instanceOf(turningCube(), {-0.5f, 0.6f, 0.8f}));
        if (step == 9) world.instances().back().placement = glm::translate(glm::mat4(1.0f), {0.3f, 0.4f, 0.5f});
        if (step == 14) world.remove(dropped);
        if (step == 18)
            world.instances()[0].placement = glm::rotate(glm::mat4(1.0f), 0.2f, glm::vec3(1, 0, 0));  // the floor, static so far
        const glm::vec3 eye(3.0f * std::sin(0.7f * float(step)), 1.0f, 0.4f * float(step));
        copy.apply(voxels.update(world, time, eye, Voxels::Wait::exact));
        // From step 18 on a complete voxelization assigns the floor to another set, so only the number of cells is compared.
        Copy fresh = fromNothing(world, time, eye);
        if (step < 18) expectSame(copy, fresh, step);
        ASSERT_EQ(copy.cells(), fresh.cells()) << step;
    }
    EXPECT_GT(copy.cells(), 2000u);
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
    copy.apply(voxels.update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::latest));
    EXPECT_TRUE(copy.bricks.empty());
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

// While the worker is blocked reading the cache file, calls return without changes. The game prints their waiting time when it ends.
TEST(Voxels, latestNeverWaitsForABuild) {
    TemporaryFolder folder;
    scene::World world;
    world.add({.model = modelOf(randomSoup(4000, 3.0f, 0.3f))});
    voxel::Options options = small();
    options.cache = folder.path();
    Copy whole;
    whole.apply(Voxels(options).update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::exact));
    ASSERT_GT(whole.cells(), 1000u);
    const std::filesystem::path file = folder.files().at(0);
    std::ostringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();

    BlockedFile blocked(file, bytes.str());
    Voxels voxels(options);
    voxels.update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::latest);
    for (uint64_t i = 1; i <= 20; ++i) {
        const Change& change = voxels.update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::latest);
        EXPECT_EQ(change.cells, 0u);
        ASSERT_EQ(voxels.statistics().late, i) << "a call waited for the build";
    }
    blocked.unblock();
    Copy copy;
    while (copy.bricks.empty()) copy.apply(voxels.update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::latest));
    EXPECT_TRUE(voxels.statistics().resting.fromCache);
    expectSame(copy, whole, 0);
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

TEST(Voxels, tooLargeWorldIsReportedOnce) {
    scene::World world;
    Soup wide;
    wide.add({-5e5f, 0, -5e5f}, {5e5f, 0, -5e5f}, {0, 0, 5e5f});
    const uint32_t id = world.add({.model = modelOf(wide)});
    std::vector<std::string> lines;
    Voxels voxels({.cells = 64, .cellSize = 0.1, .say = [&](const std::string& line) { lines.push_back(line); }});
    for (int i = 0; i < 3; ++i) EXPECT_EQ(voxels.update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::exact).cells, 0u);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("use cells of"), std::string::npos);
    world.remove(id);
    world.add(instanceOf(floorPlate()));
    EXPECT_EQ(voxels.update(world, 0.0f, glm::vec3(0.0f), Voxels::Wait::exact).cells, 64u);
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
