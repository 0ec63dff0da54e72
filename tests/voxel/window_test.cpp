// The voxel window: moving it equals rebuilding it, and changes only the bricks that enter.
#include <random>

#include "shapes.h"
#include "voxel/window.h"

namespace obscura::test {
namespace {

using voxel::Brick;
using voxel::Window;

// A world of many different bricks.
void noise(const glm::ivec3& place, Brick& out) {
    uint64_t h = uint64_t(uint32_t(place.x) + 1) * 73856093u ^ (uint64_t(uint32_t(place.y)) * 19349663u << 20) ^
                 (uint64_t(uint32_t(place.z)) * 83492791u << 32);
    for (uint64_t& word : out.words) word |= h = (h ^ h >> 29) * 0xbf58476d1ce4e5b9ull;
}

void expectSame(const Window& moved, const glm::ivec3& origin, const Window::Compose& compose) {
    Window fresh(moved.cells());
    fresh.update(origin, {}, false, compose);
    const uint32_t side = moved.cells() / 8;
    for (uint32_t address = 0; address < side * side * side; ++address) ASSERT_EQ(moved[address], fresh[address]) << address;
}

TEST(Window, movedWindowEqualsRebuilt) {
    Window window(64);
    std::mt19937 random(3);
    glm::ivec3 origin(-3, 2, -11);
    for (int step = 0; step < 40; ++step) {
        window.update(origin, {}, false, noise);
        expectSame(window, origin, noise);
        origin += glm::ivec3(int(random() % 5) - 2, int(random() % 5) - 2, int(random() % 23) - 11);
    }
}

TEST(Window, moveWritesOnlyTheEnteringSlab) {
    Window window(64);
    window.update(glm::ivec3(0), {}, false, noise);
    EXPECT_EQ(window.takeChanged(false).size(), 512u);
    window.update(glm::ivec3(1, 0, 0), {}, false, noise);
    const std::vector<uint32_t> taken = window.takeChanged(false);
    EXPECT_EQ(taken.size(), 64u);
    for (const uint32_t address : taken) EXPECT_EQ(address / 64, 0u);  // address of x = 0 before, of x = 8 now
    window.update(glm::ivec3(1, 0, 0), {}, false, noise);
    EXPECT_TRUE(window.takeChanged(false).empty());
    EXPECT_EQ(window.takeChanged(true).size(), 512u);
}

TEST(Window, onlyDifferingBricksAreWritten) {
    Window window(64);
    bool second = false;
    const auto compose = [&](const glm::ivec3& place, Brick& out) {
        noise(place, out);
        if (second && place == glm::ivec3(2, 3, 4)) out.words[5] ^= 1;
    };
    window.update(glm::ivec3(0), {}, false, compose);
    window.takeChanged(false);
    second = true;
    const std::vector<glm::ivec3> changed{{2, 3, 4}, {2, 3, 4}, {2, 3, 5}, {100, 0, 0}};
    window.update(glm::ivec3(0), changed, false, compose);
    EXPECT_EQ(window.takeChanged(false), (std::vector<uint32_t>{(2 * 8 + 3) * 8 + 4}));
    expectSame(window, glm::ivec3(0), compose);
}

// Every level holds its cells less than cells / 2 - 8 from the middle of level 0, wherever the eye is.
TEST(Window, levelsHoldTheSameMiddle) {
    constexpr int kCells = 64;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> metres(-300.0f, 300.0f);
    for (int i = 0; i < 200; ++i) {
        const glm::vec3 eye(metres(random), metres(random), metres(random));
        const glm::ivec3 centre = voxel::centreBrick(0.125, eye);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(double(centre[axis]), eye[axis] + 0.0625);
            EXPECT_GT(double(centre[axis]), eye[axis] - 1.0);
        }
        for (uint32_t level = 0; level < 6; ++level) {
            const glm::ivec3 low = voxel::windowOrigin(kCells, level, centre) * 8, high = low + kCells;  // cells of the level
            const int size = 1 << level, half = kCells / 2 - (level > 0 ? 8 : 0);
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_LE(low[axis] * size, centre[axis] * 8 - half * size) << level;
                EXPECT_GE(high[axis] * size, centre[axis] * 8 + half * size) << level;
            }
        }
    }
    const glm::ivec3 far = voxel::windowOrigin(512, 0, voxel::centreBrick(1e-3, glm::vec3(1e30f)));
    EXPECT_LE(far.x + 64, voxel::kMostCell / 8);
}

// A cell of the next level is set exactly if one of its eight cells is.
TEST(Window, nextLevelIsTheUnionOfEightCells) {
    std::mt19937 random(11);
    std::uniform_int_distribution<int> cell(-100, 100);
    voxel::BrickSet fine, coarse;
    Cells expected;
    for (int i = 0; i < 400; ++i) {
        const glm::ivec3 at(cell(random), cell(random), cell(random));
        fine.set(at);
        const glm::ivec3 above = voxel::atLevel(at, 1);
        expected.insert({above.x, above.y, above.z});
    }
    fine.nextLevel(coarse);
    EXPECT_EQ(cellsOf(coarse), expected);
}

}  // namespace
}  // namespace obscura::test
