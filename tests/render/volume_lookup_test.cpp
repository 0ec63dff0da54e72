// The shader's lookups give the same result for both structures of the volume, at every cell of every level.
#include <cstring>
#include <random>

#include <fmt/format.h>

#include "ao/view.h"
#include "gpu/compiler/compile.h"
#include "gpu/test_device.h"
#include "gpu/test_shaders.h"
#include "graph/executor.h"
#include "shared/volume.h"
#include "voxel/nano_grid.h"
#include "voxel/shapes.h"
#include "voxel/sparse.h"
#include "voxel/window.h"

namespace obscura::test {
namespace {

constexpr const char* kLookups = R"(#version 460
#define VOLUME_BINDING 1
#include "shared/volume.h"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std140) uniform VolumeBlock { Volume volumeBlock; };
layout(set = 0, binding = 2, std430) readonly buffer Places { vec4 places[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Answers { uint answers[]; };
void main() {
    Volume volume = volumeBlock;
    openVolume();
    uint i = gl_GlobalInvocationID.x * 16u;
    for (uint k = 0u; k < 16u; ++k)
        if (i + k < places.length()) {
            vec3 place = places[i + k].xyz;
            bool set = occupied(volume, place);
            float side = emptySide(volume, place);
            vec3 begin = cubeBegin(volume, place, max(side, 1.0));
            bool sound = side == 0.0 ? set : !set && all(lessThanEqual(begin, place)) && all(greaterThan(begin + side, place));
            answers[i + k] = (set ? 1u : 0u) | (sound ? 0u : 2u);
        }
}
)";

class VolumeLookupTest : public GpuTest {
protected:
    std::vector<uint32_t> ask(
        bool grid, const shared::Volume& block, std::span<const uint32_t> words, const std::vector<glm::vec4>& places) {
        TestShaders shaders;
        std::string text = kLookups;
        if (grid) text.insert(text.find("#define"), "#define VOLUME_NANOVDB\n");
        shaders.add("lookup.comp", text, std::filesystem::path(OBSCURA_SOURCE_DIR) / "shaders");
        if (HasFailure()) return {};
        gpu::Program program;
        EXPECT_EQ(gpu::Program::compute(device(), shaders.library, "lookup.comp", {}, program), gpu::Status::ok);
        graph::Graph graph(device());
        graph::Executor executor(device());
        device().nextFrame();
        graph.begin();
        gpu::Buffer back;
        const uint64_t bytes = places.size() * sizeof(uint32_t);
        EXPECT_EQ(
            gpu::Buffer::create(device(), bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback, "back", back), gpu::Status::ok);
        const graph::BufferId answers = graph.buffer("answers", bytes);
        graph.pass("look up", program)
            .read(graph.upload("block", block))
            .read(graph.upload("bits", words.data(), words.size_bytes()))
            .read(graph.upload("places", places.data(), places.size() * sizeof(glm::vec4)))
            .write(answers)
            .dispatch(uint32_t(places.size() + 15) / 16);
        graph.pass("read back")
            .use(answers, graph::Access::transferRead)
            .use(graph.import("back", back, graph::Graph::Shared::written), graph::Access::transferWrite)
            .keep()
            .record([=, to = back.handle()](const graph::PassContext& c) {
                const VkBufferCopy copy{c.buffer(answers).offset, 0, bytes};
                c.device.vk().CmdCopyBuffer(c.cmd, c.buffer(answers).buffer, to, 1, &copy);
            });
        EXPECT_EQ(device().runNow([&](VkCommandBuffer cmd) { EXPECT_EQ(executor.execute(graph, cmd), gpu::Status::ok); }), gpu::Status::ok);
        std::vector<uint32_t> result(places.size());
        std::memcpy(result.data(), back.mapped(), bytes);
        EXPECT_NE(program.pipeline(), VK_NULL_HANDLE);
        device().waitIdle();
        return result;
    }

    static shared::Volume blockOf(const glm::ivec3& origin, ao::Volume volume) {
        for (int axis = 0; axis < 3; ++axis) volume.origin[axis] = origin[axis];
        for (int i = 0; i < 16; i += 5) volume.cellFromEye[i] = 1.0f;
        shared::Volume block{};
        const char* reason = nullptr;
        EXPECT_EQ(ao::volumeOf(volume, block, reason), ao::Status::ok) << (reason ? reason : "");
        return block;
    }

    // Compares the cells of a window of 64 around `origin` in both structures with the set.
    void expectSame(const voxel::BrickSet& cells, const glm::ivec3& origin) {
        voxel::Sparse sparse;
        sparse.add(cells);
        voxel::Window window(64);
        window.update(origin / 8, {}, true, [&](const glm::ivec3& place, voxel::Brick& out) { sparse.find(place, out); });
        std::vector<uint32_t> dense(64 * 64 * 64 / 32, 0);
        for (const uint32_t address : window.takeChanged(true)) std::memcpy(&dense[address * 16], &window[address], sizeof(voxel::Brick));
        const shared::Volume block = blockOf(origin, {.cells = 64}), gridBlock = blockOf(origin, {ao::VolumeStructure::nanovdb});

        std::vector<glm::vec4> places;  // every cell of the window, then random cells in and around it
        places.reserve(64 * 64 * 64 + 40000);
        for (int i = 0; i < 64 * 64 * 64; ++i)
            places.emplace_back(float(i / 4096) + 0.5f, float(i / 64 % 64) + 0.5f, float(i % 64) + 0.5f, 0.0f);
        std::mt19937 random(5);
        std::uniform_real_distribution<float> anywhere(0.01f, 63.99f), far(-5000.0f, 5000.0f);
        for (int i = 0; i < 20000; ++i) places.emplace_back(anywhere(random), anywhere(random), anywhere(random), 0.0f);
        const size_t within = places.size();
        for (int i = 0; i < 20000; ++i) places.emplace_back(far(random), far(random), far(random), 0.0f);
        const std::vector<uint32_t> bits = ask(false, block, dense, places), grid = ask(true, gridBlock, sparse.nano(), places);
        ASSERT_EQ(bits.size(), places.size());
        ASSERT_EQ(grid.size(), places.size());
        size_t set = 0;
        for (size_t i = 0; i < places.size(); ++i) {
            const bool expected = cells.test(origin + glm::ivec3(glm::floor(glm::vec3(places[i]))));
            ASSERT_EQ(grid[i], expected ? 1u : 0u)
                << "grid, place " << i << ": " << places[i].x << ' ' << places[i].y << ' ' << places[i].z;
            if (i < within) {
                ASSERT_EQ(bits[i], grid[i]) << "bits, place " << i;
            }
            set += expected;
        }
        fmt::print("{} of {} cells set\n", set, places.size());
    }
};

TEST_F(VolumeLookupTest, bothStructuresAgree) {
    voxel::BrickSet random;
    const Soup soup = randomSoup(400, 6.0f, 3.0f, 4);
    voxel::rasterise(soup.triangles(), 0.1, random);
    for (const glm::ivec3& origin : {glm::ivec3(-32), glm::ivec3(16, -40, 8)}) expectSame(random, origin);
    voxel::BrickSet structured;  // corners of nodes, a full brick, lone cells far away
    for (const int at : {-4096, -129, -128, -1, 0, 7, 8, 127, 128, 4095, 4096})
        for (const int other : {-1, 0, 31}) structured.set({at, other, -other});
    for (int i = 0; i < 512; ++i) structured.set({16 + i / 64, 8 + i / 8 % 8, i % 8});
    for (const glm::ivec3& origin : {glm::ivec3(-32), glm::ivec3(-8, -8, -32), glm::ivec3(4064, -32, -32)}) expectSame(structured, origin);
    expectSame(voxel::BrickSet(), glm::ivec3(0));
}

// Three levels of 64 cells: in each place the finest level answers that holds it, and a cell of level k is the union of 8^k cells.
TEST_F(VolumeLookupTest, levelsAgree) {
    voxel::BrickSet cells[3];
    voxel::rasterise(randomSoup(600, 16.0f, 3.0f, 5).triangles(), 0.1, cells[0]);
    for (int k = 1; k < 3; ++k) cells[k - 1].nextLevel(cells[k]);
    // Both copies are edited as the windows move.
    std::vector<voxel::Window> windows(3, voxel::Window(64));
    constexpr uint32_t kWords = 64 * 64 * 64 / 32;
    std::vector<uint32_t> dense(3 * kWords, 0), copy;
    voxel::NanoGrid edited;
    for (const glm::vec3& eye : {glm::vec3(0.0f), glm::vec3(-7.3f, 2.9f, 5.55f), glm::vec3(5.0f, -6.0f, 0.4f)}) {
        const glm::ivec3 centre = voxel::centreBrick(0.1, eye), origin = voxel::windowOrigin(64, 0, centre) * 8;
        for (uint32_t k = 0; k < 3; ++k) {
            windows[k].update(voxel::windowOrigin(64, k, centre), {}, false, [&](const glm::ivec3& place, voxel::Brick& out) {
                if (const voxel::Brick* brick = cells[k].find(place)) out = *brick;
            });
            for (const uint32_t address : windows[k].takeChanged(false)) {
                std::memcpy(&dense[k * kWords + address * 16], &windows[k][address], sizeof(voxel::Brick));
                edited.put({k * 8 + address / 64, address / 8 % 8, address % 8}, windows[k][address]);
            }
        }
        copy.resize(edited.words().size());
        for (const voxel::NanoGrid::Range& range : edited.takeChanged())
            std::memcpy(&copy[range.offset / 4], &edited.words()[range.offset / 4], range.bytes);
        ASSERT_TRUE(std::equal(copy.begin(), copy.end(), edited.words().begin(), edited.words().end()));
        const shared::Volume block = blockOf(origin, {.cells = 64, .levels = 3}),
                             gridBlock = blockOf(origin, {ao::VolumeStructure::nanovdb, VK_NULL_HANDLE, 0, 0, 64, 3});
        // Places are counted from the anchor. Levels hold less than 24, 48 and 96 cells of level 0 from the middle.
        const glm::ivec3 anchor(int(block.anchor.x), int(block.anchor.y), int(block.anchor.z)), middle = origin + 32;
        EXPECT_EQ(anchor.x % 4, 0);
        std::vector<glm::vec4> places;
        std::mt19937 random(6);
        std::uniform_real_distribution<float> anywhere(-100.0f, 100.0f);
        for (int i = 0; i < 200000; ++i) {
            const float scale = i % 3 == 0 ? 0.25f : i % 3 == 1 ? 0.5f : 1.0f;
            const glm::vec3 place(scale * anywhere(random), scale * anywhere(random), scale * anywhere(random));
            places.emplace_back(place + glm::vec3(middle - anchor), 0.0f);
        }
        const std::vector<uint32_t> bits = ask(false, block, dense, places), grid = ask(true, gridBlock, copy, places);
        ASSERT_EQ(bits.size(), places.size());
        size_t set[3] = {};
        for (size_t i = 0; i < places.size(); ++i) {
            const glm::vec3 from = glm::abs(glm::vec3(places[i]) - glm::vec3(middle - anchor));
            const float far = std::max({from.x, from.y, from.z});
            const uint32_t level = far < 24.0f ? 0 : far < 48.0f ? 1 : 2;
            const bool expected =
                far < 96.0f && cells[level].test(voxel::atLevel(anchor + glm::ivec3(glm::floor(glm::vec3(places[i]))), level));
            if (far < 96.0f) {  // the empty cube is right as well
                ASSERT_EQ(bits[i], expected ? 1u : 0u) << "place " << i << ", level " << level;
            }
            ASSERT_EQ(bits[i] & 1u, expected ? 1u : 0u);
            ASSERT_EQ(grid[i] & 1u, bits[i] & 1u) << "grid, place " << i << ", level " << level;
            set[level] += expected;
        }
        fmt::print("{}, {} and {} of {} places set\n", set[0], set[1], set[2], places.size());
        for (const size_t count : set) EXPECT_GT(count, 50u);
    }
}

TEST_F(VolumeLookupTest, bricksAreReplaced) {
    voxel::BrickSet cells;
    cells.set({1, 2, 3});
    cells.set({100, 0, 0});
    voxel::Sparse sparse;
    sparse.add(cells);
    voxel::Brick brick;
    brick.set(4, 4, 4);
    EXPECT_TRUE(sparse.put({0, 0, 0}, brick));
    EXPECT_FALSE(sparse.put({0, 0, 0}, brick));
    EXPECT_FALSE(sparse.test({1, 2, 3}));
    EXPECT_TRUE(sparse.test({4, 4, 4}));
    EXPECT_TRUE(sparse.put({12, 0, 0}, {}));
    EXPECT_FALSE(sparse.put({12, 0, 0}, {}));
    EXPECT_EQ(sparse.bricks(), 1u);
    EXPECT_EQ(sparse.cells(), 1u);
}

}  // namespace
}  // namespace obscura::test
